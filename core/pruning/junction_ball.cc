#include "core/pruning/junction_ball.h"

#include <algorithm>

#include "core/pruning/point_table.h"

namespace bccskel {
namespace {

constexpr double kLeastRadius = 0.3;   // least radius of a body's end there, in the ball's radii
constexpr double kThinnerLimb = 0.85;  // largest radius of the other limbs, in radii of the end
constexpr double kMostPoints = 1024;   // a closed surface or dense hair fills the whole ball
constexpr double kMostPerUnit = 8;     // of its radius; curves have one point per unit at most

}  // namespace

JunctionBall::JunctionBall(const ThinSet& set, LatticePoint center,
                           std::span<const LatticePoint> without, double radii)
    : radius_(set.RadiusOf(center)), reach_(radii * radius_), visited_{{center}} {
  const auto most = static_cast<size_t>(std::max(kMostPoints, kMostPerUnit * radius_));
  PointTable<size_t> seen;  // index of each in visited_
  seen.Set(center, 0);
  if (!without.empty()) seen.Set(without.back(), 0);
  for (size_t n = 0; n < visited_.size(); ++n) {
    if (n == most) {
      exits_.clear();
      return;
    }
    const LatticePoint p = visited_[n].p;
    const bool outside = n > 0 && set.Between(center, p) >= reach_;
    if (outside || (n > 0 && set.IsEnd(p))) {
      if (exits_.empty() || set.RadiusOf(p) > set.RadiusOf(visited_[body_].p)) body_ = n;
      exits_.push_back(n);
    }
    if (outside) continue;
    ForEachNeighbor(p, set.NeighborsOf(p), [&](LatticePoint q) {
      if (seen.Find(q) != nullptr) return;
      seen.Set(q, visited_.size());
      visited_.push_back({q, n});
    });
  }
}

double JunctionBall::ThickestLimb(const ThinSet& set) const {
  double thickest = 0;
  for (size_t exit : exits_) {
    const LatticePoint p = visited_[exit].p;
    if (set.Between(p, visited_[body_].p) < reach_) continue;
    thickest = std::max<double>(thickest, set.RadiusOf(p));
  }
  return thickest;
}

std::vector<LatticePoint> JunctionBall::WayTo(size_t visited) const {
  std::vector<LatticePoint> way = {visited_[visited].p};
  for (size_t n = visited; n != 0;) {
    n = visited_[n].before;
    way.push_back(visited_[n].p);
  }
  std::ranges::reverse(way);
  return way;
}

bool IsBodyEnd(const ThinSet& set, const FreeBranch& branch, bool may_end_inside) {
  const LatticePoint junction = *branch.junction;
  if (!set.Branches(junction)) return false;
  const double radius = set.RadiusOf(junction);
  const auto exit = std::find_if(branch.points.rbegin(), branch.points.rend(), [&](LatticePoint p) {
    return set.Between(junction, p) >= JunctionBall::kExit * radius;
  });
  const bool ends_inside = exit == branch.points.rend();
  if (ends_inside && !may_end_inside) return false;
  const double own = set.RadiusOf(ends_inside ? branch.points[0] : *exit);
  if (own < kLeastRadius * radius) return false;
  const JunctionBall ball(set, junction, branch.points);
  return !ball.exits().empty() && ball.ThickestLimb(set) <= kThinnerLimb * own;
}

}  // namespace bccskel
