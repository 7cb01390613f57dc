#include "core/import/shapes/branching.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/import/shapes/random.h"

namespace bccskel::shapes {
namespace {

constexpr int kTriesPerFork = 400;

double DistanceToSegment(Vector p, const RoundCone& segment) {
  const Vector axis = segment.to - segment.from;
  const double t = std::clamp(Dot(p - segment.from, axis) / Dot(axis, axis), 0.0, 1.0);
  return Length(segment.from + t * axis - p);
}

// Between the axes of two branches: at an end of one of them, or between the lines' nearest points
// when both lie within the segments.
double DistanceBetween(const RoundCone& a, const RoundCone& b) {
  const double at_ends = std::min({DistanceToSegment(a.from, b), DistanceToSegment(a.to, b),
                                   DistanceToSegment(b.from, a), DistanceToSegment(b.to, a)});
  const Vector u = a.to - a.from, v = b.to - b.from, w = b.from - a.from;
  const Vector normal = Cross(u, v);
  const double area = Dot(normal, normal);
  if (area == 0) return at_ends;
  const double s = Dot(Cross(w, v), normal) / area, t = Dot(Cross(w, u), normal) / area;
  if (s < 0 || s > 1 || t < 0 || t > 1) return at_ends;
  return std::min(at_ends, std::abs(Dot(w, normal)) / std::sqrt(area));
}

bool Meet(const RoundCone& a, const RoundCone& b) {
  const auto same = [](Vector p, Vector q) { return Dot(p - q, p - q) == 0; };
  return same(a.from, b.to) || same(a.from, b.from) || same(a.to, b.from);
}

Vector AcrossOf(Vector direction, Random& random) {
  while (true) {
    const Vector across = Cross(direction, random.InUnitBall());
    if (Length(across) > 0.1) return Unit(across);
  }
}

class Growth {
 public:
  Growth(const BranchingPlan& plan, uint64_t seed) : plan_(plan), random_(seed) {}

  // Nothing when a fork found no room.
  std::optional<std::vector<RoundCone>> Grow() {
    branches_ = {{{0, 0, 0}, {0, 0, plan_.trunk_length}, 1, EndRadius(1)}};
    std::vector<RoundCone> tips = branches_;
    for (int level = 0; level < plan_.levels; ++level) {
      std::vector<RoundCone> next;
      for (const RoundCone& tip : tips) {
        if (!Fork(tip, next)) return std::nullopt;
      }
      tips = next;
    }
    for (int n = 0; n < plan_.side_branches; ++n) {
      if (!AddSideBranch()) return std::nullopt;
    }
    return branches_;
  }

 private:
  double EndRadius(double radius) const {
    return plan_.taper == Taper::kNone ? radius : radius * plan_.radius_ratio;
  }

  bool HasRoom(const RoundCone& branch, size_t without_last) const {
    const double radius = std::max(branch.from_radius, branch.to_radius);
    return std::all_of(branches_.begin(), branches_.end() - static_cast<ptrdiff_t>(without_last),
                       [&](const RoundCone& other) {
                         const double reach = radius + other.from_radius + plan_.gap;
                         return Meet(branch, other) || DistanceBetween(branch, other) > reach;
                       });
  }

  // `lean` is the sideways part of the direction, in units of the forward part.
  RoundCone BranchFrom(const RoundCone& parent, Vector origin, Vector lean) const {
    const Vector axis = parent.to - parent.from;
    const Vector direction = Unit(Unit(axis) + lean);
    const double radius = parent.from_radius * plan_.radius_ratio;
    return {origin, origin + plan_.length_ratio * Length(axis) * direction, radius,
            EndRadius(radius)};
  }

  bool Fork(const RoundCone& tip, std::vector<RoundCone>& next) {
    for (int n = 0; n < kTriesPerFork; ++n) {
      const Vector across = AcrossOf(Unit(tip.to - tip.from), random_);
      const RoundCone left = BranchFrom(tip, tip.to, random_.Between(0.7, 1.2) * across);
      const RoundCone right = BranchFrom(tip, tip.to, random_.Between(-1.2, -0.7) * across);
      if (!HasRoom(left, 0) || !HasRoom(right, 0)) continue;
      for (const RoundCone& branch : {left, right}) {
        branches_.push_back(branch);
        next.push_back(branch);
      }
      return true;
    }
    return false;
  }

  // From the lower half of the trunk, at a steep angle.
  bool AddSideBranch() {
    const RoundCone trunk = branches_.front();
    for (int n = 0; n < kTriesPerFork; ++n) {
      const Vector across = AcrossOf({0, 0, 1}, random_);
      const Vector origin = {0, 0, trunk.to.z * random_.Between(0.3, 0.5)};
      const RoundCone branch = BranchFrom(trunk, origin, 3 * across);
      // The trunk itself, which the branch leaves, is the first of all.
      const std::vector<RoundCone> others(branches_.begin() + 1, branches_.end());
      const bool room = std::ranges::all_of(others, [&](const RoundCone& other) {
        return DistanceBetween(branch, other) > branch.from_radius + other.from_radius + plan_.gap;
      });
      if (!room) continue;
      branches_.push_back(branch);
      return true;
    }
    return false;
  }

  const BranchingPlan& plan_;
  Random random_;
  std::vector<RoundCone> branches_;
};

}  // namespace

std::vector<Solid> GrowBranches(const BranchingPlan& plan, uint64_t seed) {
  // Another seed when a fork had no room. The constant keeps the trees of near seeds apart.
  for (uint64_t attempt = seed;; attempt += 0x9e3779b97f4a7c15) {
    const auto branches = Growth(plan, attempt).Grow();
    if (branches) return {branches->begin(), branches->end()};
  }
}

}  // namespace bccskel::shapes
