#include "core/pruning/attachments.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/distance/places.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/simple_points.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

constexpr int kMostPasses = 3;
constexpr size_t kMostReached = 5000;  // points; more are a sheet
constexpr double kWay = 2;           // radii along the curves, from which on it is beside the other
constexpr double kBallPart = 0.9;    // radii
constexpr double kGap = 4;           // lattice units that may lie outside all balls
constexpr double kLeastGain = 5;     // lattice units
constexpr double kLeastShare = 0.3;  // of the ball's radius
constexpr double kShorter = 0.4;     // of the way that it replaces
constexpr double kBodyShare = 0.6;  // of the junction's radius: the other curve runs on in the body
constexpr double kReach = 4;        // radii of the junction
constexpr double kArmStep = 2;      // lattice units, between places where the arm may be cut
constexpr double kSlant = 0.4;      // how far before the foot, relative to the way across
constexpr double kSampling = 0.5;   // lattice units

// From a junction along curve points; the junction is not one of them.
struct Arm {
  LatticePoint junction;
  std::vector<LatticePoint> points;
};

// Where an arm should begin.
struct Attachment {
  size_t last = 0;                  // position in the arm: the new way begins there
  std::vector<LatticePoint> trunk;  // the curve beside it, from the junction to the new way's end
};

class Slider {
 public:
  Slider(ThinSet& set, const Volume& object, const ExactRadius& radius, const PointSet& keep,
         const exec::Context& context, PruningLevels& levels)
      : set_(set),
        scale_(AxisScaleOf(object.placement())),
        bricks_(object),
        radius_(radius),
        keep_(keep),
        context_(context),
        levels_(levels) {}

  void Run() {
    for (int pass = 0; pass < kMostPasses && SlideAll(); ++pass) {
    }
  }

 private:
  // Returns whether anything moved.
  bool SlideAll() {
    std::vector<LatticePoint> junctions;
    set_.ForEachBranchPoint([&](LatticePoint p) {
      ForEachNeighbor(p, set_.NeighborsOf(p), [&](LatticePoint junction) {
        if (set_.Degree(junction) > 2) junctions.push_back(junction);
      });
    });
    std::ranges::sort(junctions);
    junctions.erase(std::unique(junctions.begin(), junctions.end()), junctions.end());
    bool moved = false;
    for (LatticePoint junction : junctions) {
      if (context_.ShouldStop()) return false;
      if (set_.Contains(junction) && SlideFrom(junction)) moved = true;
    }
    return moved;
  }

  bool SlideFrom(LatticePoint junction) {
    bool moved = false;
    ForEachNeighbor(junction, set_.NeighborsOf(junction), [&](LatticePoint start) {
      if (!set_.Contains(junction) || set_.Degree(junction) <= 2) return;
      if (!set_.Contains(start) || set_.Degree(start) > 2) return;
      const Arm arm = ArmFrom(junction, start);
      const std::optional<Attachment> better = BetterFor(arm);
      if (better.has_value() && Slide(arm, *better)) moved = true;
    });
    return moved;
  }

  // As far as it may have to move.
  Arm ArmFrom(LatticePoint junction, LatticePoint start) const {
    const double reach = kReach * set_.RadiusOf(junction);
    Arm arm{junction, {start}};
    LatticePoint previous = junction, p = start;
    for (NeighborMask mask = set_.NeighborsOf(p); IsPair(mask); mask = set_.NeighborsOf(p)) {
      const LatticePoint next = NextPoint(p, mask, previous);
      if (set_.Degree(next) > 2 || next == start || set_.Between(next, junction) > reach) break;
      arm.points.push_back(next);
      previous = p;
      p = next;
    }
    return arm;
  }

  struct Reached {
    LatticePoint point;
    size_t from;  // position of the one before
    Coordinates place;
    double radius;
    double way;  // straight from the junction
  };

  // The points of other curves of the same body, breadth first, the junction first.
  std::vector<Reached> BodyAround(const Arm& arm) const {
    const double ball = set_.RadiusOf(arm.junction);
    std::vector<Reached> body = {{arm.junction, 0, PlaceOf(arm.junction, scale_), ball, 0}};
    PointSet seen = {arm.junction, arm.points.front()};
    for (size_t n = 0; n < body.size() && body.size() < kMostReached; ++n) {
      const LatticePoint p = body[n].point;
      ForEachNeighbor(p, set_.NeighborsOf(p), [&](LatticePoint q) {
        const double radius = set_.RadiusOf(q), way = set_.Between(q, arm.junction);
        if (radius < kBodyShare * ball || way > kReach * ball || !seen.insert(q).second) return;
        body.push_back({q, n, PlaceOf(q, scale_), radius, way});
      });
    }
    return body;
  }

  // The attachment that makes the branch shortest. Ways are straight, since those along lattice
  // points depend on their direction.
  std::optional<Attachment> BetterFor(const Arm& arm) const {
    const double ball = set_.RadiusOf(arm.junction);
    // Nearer to the junction nothing is long enough to count.
    const double nearest = kBodyShare * kWay / (2 + 1 - kShorter) * ball;
    if (set_.Between(arm.points.back(), arm.junction) < std::max(nearest, kLeastGain)) {
      return std::nullopt;
    }
    const std::vector<Reached> body = BodyAround(arm);
    size_t last = 0, center = 0;
    double most = kLeastGain, looked_at = nearest;
    for (size_t n = 0; n < arm.points.size(); ++n) {
      const LatticePoint q = arm.points[n];
      const Coordinates place = PlaceOf(q, scale_);
      const double radius = set_.RadiusOf(q), way = set_.Between(q, arm.junction);
      if (way < looked_at + kArmStep) continue;
      looked_at = way;
      for (size_t m = 0; m < body.size(); ++m) {
        const Reached& other = body[m];
        if (other.radius < radius || other.way + way <= kWay * other.radius) continue;
        const Coordinates across = Sum(other.place, -1, place);
        const double square = Dot(across, across), reach = kBallPart * other.radius;
        if (square >= reach * reach) continue;
        const double gain = way - std::sqrt(square);
        if (gain <= most || gain < kLeastShare * other.radius || gain < kShorter * way) continue;
        most = gain;
        last = n;
        center = m;
      }
    }
    if (center == 0) return std::nullopt;
    const double at =
        body[center].way - kSlant * set_.Between(body[center].point, arm.points[last]);
    if (at <= kGap) return std::nullopt;
    Attachment better{last, {}};
    for (size_t m = center; m != 0; m = body[m].from) {
      if (body[m].way <= at || !better.trunk.empty()) better.trunk.push_back(body[m].point);
    }
    if (better.trunk.empty()) return std::nullopt;
    better.trunk.push_back(arm.junction);
    std::ranges::reverse(better.trunk);
    return better;
  }

  // The points of the object between the old way and the curve beside it: how far along, from the
  // junction on.
  PointTable<double> Between(const Arm& arm, const Attachment& better) {
    PointTable<double> between;
    const size_t steps = 2 * std::max(better.last + 1, better.trunk.size());
    for (size_t n = 0; n <= steps; ++n) {
      const size_t along = n * (better.last + 1) / steps;
      const LatticePoint old = along == 0 ? arm.junction : arm.points[along - 1];
      const Coordinates a = PlaceOf(better.trunk[n * (better.trunk.size() - 1) / steps], scale_);
      const Coordinates across = Sum(PlaceOf(old, scale_), -1, a);
      const int samples = static_cast<int>(std::sqrt(Dot(across, across)) / kSampling) + 1;
      for (int s = 0; s <= samples; ++s) {
        const double share = static_cast<double>(s) / samples;
        const LatticePoint near = PointNear(Sum(a, share, across), scale_);
        Offer(near, static_cast<double>(n), between);
        for (LatticePoint d : kDirections14) Offer(near + d, static_cast<double>(n), between);
      }
    }
    return between;
  }

  void Offer(LatticePoint p, double share, PointTable<double>& between) {
    if (between.Find(p) == nullptr && bricks_.Contains(p)) between.Set(p, share);
  }

  // Returns whether the arm moved.
  bool Slide(const Arm& arm, const Attachment& better) {
    std::vector<LatticePoint> old_way(
        arm.points.begin(), arm.points.begin() + static_cast<std::ptrdiff_t>(better.last));
    if (std::ranges::any_of(old_way, [&](LatticePoint p) { return keep_.contains(p); }))
      return false;
    const LatticePoint q = arm.points[better.last], target = better.trunk.back();
    std::vector<std::pair<LatticePoint, float>> before;
    for (LatticePoint p : old_way) before.emplace_back(p, set_.RadiusOf(p));
    const PointTable<double> between = Between(arm, better);
    PointSet ends;
    between.ForEach([&](LatticePoint p, double) {
      if (set_.Contains(p) && set_.Degree(p) == 1) ends.insert(p);
    });
    const std::vector<LatticePoint> added = Fill(between);
    std::vector<LatticePoint> loose = added;
    loose.insert(loose.end(), old_way.begin(), old_way.end());
    const std::vector<LatticePoint> left = Thin(loose, PlaceOf(q, scale_), PlaceOf(target, scale_));
    if (static_cast<double>(left.size()) > set_.Between(q, target) + kGap) {
      Restore(before, added);
      return false;
    }
    Settle(left, q, arm.junction, ends);
    return true;
  }

  // Adds points, each simple at its turn, the nearest to the junction first.
  std::vector<LatticePoint> Fill(const PointTable<double>& between) {
    std::vector<LatticePoint> added;
    std::set<std::pair<double, LatticePoint>> turns;
    between.ForEach([&](LatticePoint p, double share) { turns.emplace(share, p); });
    while (!turns.empty()) {
      const LatticePoint p = turns.begin()->second;
      turns.erase(turns.begin());
      if (set_.Contains(p) || !IsSimple(set_.NeighborsAround(p))) continue;
      set_.Add(p, 0);
      added.push_back(p);
      for (LatticePoint d : kDirections14) {
        const double* share = between.Find(p + d);
        if (share != nullptr && !set_.Contains(p + d)) turns.emplace(*share, p + d);
      }
    }
    return added;
  }

  // Removes of these points what is simple at its turn, the farthest from the straight way first.
  // Returns those left.
  std::vector<LatticePoint> Thin(const std::vector<LatticePoint>& loose, const Coordinates& from,
                                 const Coordinates& to) {
    PointTable<double> off;
    const Coordinates way = Sum(to, -1, from);
    const double square = std::max(Dot(way, way), 1.0);
    std::set<std::pair<double, LatticePoint>> turns;
    for (LatticePoint p : loose) {
      const Coordinates out = Sum(PlaceOf(p, scale_), -1, from);
      const double along = std::clamp(Dot(out, way) / square, 0.0, 1.0);
      const Coordinates rest = Sum(out, -along, way);
      off.Set(p, -Dot(rest, rest));
      turns.emplace(-Dot(rest, rest), p);
    }
    while (!turns.empty()) {
      const LatticePoint p = turns.begin()->second;
      turns.erase(turns.begin());
      if (!set_.Contains(p)) continue;
      const NeighborMask neighbors = set_.NeighborsOf(p);
      if (!IsSimple(neighbors)) continue;
      set_.Remove(p);
      ForEachNeighbor(p, neighbors, [&](LatticePoint n) {
        const double* place = off.Find(n);
        if (place != nullptr) turns.emplace(*place, n);
      });
    }
    std::vector<LatticePoint> left;
    for (LatticePoint p : loose) {
      if (set_.Contains(p)) left.push_back(p);
    }
    return left;
  }

  void Restore(const std::vector<std::pair<LatticePoint, float>>& before,
               const std::vector<LatticePoint>& added) {
    for (LatticePoint p : added) {
      if (set_.Contains(p)) set_.Remove(p);
    }
    for (const auto& [p, radius] : before) {
      if (!set_.Contains(p)) set_.Add(p, radius);
    }
  }

  // Measures the new points and removes what has become simple, and ends that are none.
  void Settle(const std::vector<LatticePoint>& left, LatticePoint q, LatticePoint junction,
              const PointSet& ends) {
    const double* found = levels_.Find(q);
    const double level = found != nullptr ? *found : -1;  // of q, or it has none
    std::set<LatticePoint> around = {q, junction};
    for (LatticePoint p : left) {
      if (set_.RadiusOf(p) == 0) set_.SetRadius(p, radius_.At(p));
      if (level >= 0) levels_.Set(p, level);
      around.insert(p);
    }
    std::set<LatticePoint> wider = around;
    for (LatticePoint p : around) {
      ForEachNeighbor(p, set_.NeighborsOf(p), [&](LatticePoint n) { wider.insert(n); });
    }
    RemoveSimplePoints(set_, wider, keep_);
    for (LatticePoint p : wider) RemoveSpur(p, ends);
  }

  // Removes the curve from p on if it ends there, as none did before.
  void RemoveSpur(LatticePoint p, const PointSet& ends) {
    std::set<LatticePoint> around;
    while (set_.Contains(p) && set_.Degree(p) == 1 && !keep_.contains(p) && !ends.contains(p)) {
      const LatticePoint next = NextPoint(p, set_.NeighborsOf(p), p);
      set_.Remove(p);
      p = next;
      around = {p};
      ForEachNeighbor(p, set_.NeighborsOf(p), [&](LatticePoint n) { around.insert(n); });
    }
    RemoveSimplePoints(set_, around, keep_);
  }

  ThinSet& set_;
  const AxisScale scale_;
  NearbyBricks bricks_;
  ExactRadius radius_;
  const PointSet& keep_;
  const exec::Context& context_;
  PruningLevels& levels_;
};

}  // namespace

void SlideAttachments(ThinSet& set, const Volume& object, const ExactRadius& radius,
                      const PointSet& keep, const exec::Context& context, PruningLevels& levels) {
  Slider(set, object, radius, keep, context, levels).Run();
}

}  // namespace bccskel
