#include "core/pruning/grow_missed_limbs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/stop_poll.h"
#include "core/pruning/ball_gaps.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/grow_along.h"
#include "core/pruning/junction_ball.h"
#include "core/pruning/point_table.h"

namespace bccskel {
namespace {

// Of a limb's tip outside the ball, in its radii and in steps of the surface.
constexpr double kLeastGap = 0.4, kLeastGapSteps = 4;
// Of the bodies that have such limbs: the least radius in the largest of their component's. Of
// both: the largest half-width in radii. In flat parts, thinning leaves curves out where there are
// no limbs.
constexpr double kThick = 0.35, kRound = 1.5;
// Of the way from the tip to the curve: how far around it may lead, in lengths of the straight way,
// and the weight of coming nearer against the rise of the depth.
constexpr double kWayAround = 1.3, kToward = 0.2;
constexpr double kWayAroundUnits = 4;
// Where on the curve a limb may begin, as for the ends of bodies: around the end of that way, in
// radii of the ball there, and how many points are tried.
constexpr double kStartsAround = 0.4;
constexpr size_t kStartsTried = 16;
constexpr double kInset = 0.15;  // of its length: the tip may lie on the rim
constexpr double kNearEnd = 2;   // the distance of ends in the same part, in its lengths
// Of places where a limb may be round: the largest half-width in radii, less than that of corners,
// the least depth, in radii of its root, and from one to the next, in points.
constexpr double kRoundLimb = 1.3, kLeastDepthOfRoot = 0.25;
constexpr size_t kNextPlace = 3;
constexpr size_t kLeastPoints = 4;  // of a limb
constexpr int32_t kLeastEdge = 8;   // of cubes

// The largest radius of each component of the set, at each of its points.
PointTable<float> LargestRadii(const ThinSet& set, StopPoll& poll) {
  PointTable<float> largest;
  std::vector<LatticePoint> points, component;
  set.ForEachPoint([&](LatticePoint p) { points.push_back(p); });
  largest.Reserve(points.size());
  for (LatticePoint start : points) {
    if (largest.Find(start) != nullptr) continue;
    component = {start};
    largest.Set(start, 0);
    float most = 0;
    for (size_t n = 0; n < component.size() && !poll.Stopped(); ++n) {
      most = std::max(most, set.RadiusOf(component[n]));
      ForEachNeighbor(component[n], set.NeighborsOf(component[n]), [&](LatticePoint q) {
        if (largest.Find(q) != nullptr) return;
        largest.Set(q, 0);
        component.push_back(q);
      });
    }
    for (LatticePoint p : component) largest.Set(p, most);
  }
  return largest;
}

class MissedLimbs {
 public:
  MissedLimbs(ThinSet& set, const PrunedObject& in, FirmDepth& depth, const SurfaceNoise& noise,
              Significance& significance, double threshold)
      : set_(set),
        bricks_(in.object),
        radius_(in.radius),
        depth_(depth),
        sections_(in.object),
        noise_(noise),
        significance_(significance),
        threshold_(threshold),
        ends_(set.Ends()) {}

  void GrowTo(const BallGaps::Peak& peak) {
    const auto& [tip, ball, gap] = peak;
    const double stretch = noise_.Stretch(set_.Way(ball.center, tip));
    const double least = std::max(kLeastGapSteps * stretch * noise_.step, kLeastGap * ball.radius);
    if (gap < least || IsNearGrown(tip, least)) return;
    if (!significance_.MayHaveBodyEnds(ball.radius / stretch)) return;
    if (!set_.Contains(ball.center) || !IsRoundAt(ball.center) ||
        !Sees(PlaceOf(tip, set_.scale()), PlaceOf(ball.center, set_.scale())))
      return;
    const std::vector<LatticePoint> way = WayFrom(tip, ball.center);
    if (way.empty() || !GrowAgainst(way)) return;
    for (size_t n = 1; n < path_.size(); ++n) set_.SetRadius(path_[n], radius_.At(path_[n]));
    if (IsLimb() && !SeesAnotherEnd()) {
      grown_.insert(grown_.end(), path_.begin() + 1, path_.end());
      ends_.push_back(path_.back());
    } else {
      for (; path_.size() > 1; path_.pop_back()) set_.Remove(path_.back());
    }
  }

 private:
  // Whether the balls of the limbs that grew leave a smaller gap.
  bool IsNearGrown(LatticePoint tip, double least) const {
    return std::ranges::any_of(
        grown_, [&](LatticePoint p) { return set_.Between(p, tip) - set_.RadiusOf(p) < least; });
  }

  bool IsRoundAt(LatticePoint center) {
    const JunctionBall ball(set_, center);
    if (ball.exits().empty()) return false;
    const Coordinates on = Unit(set_.Way(ball.visited()[ball.body()].p, center));
    return IsRound(center, on, ball.radius(), kRound);
  }

  // Whether another end lies in the same flat part: nothing is between the two.
  bool SeesAnotherEnd() {
    const LatticePoint root = path_.front(), tip = path_.back();
    const double far = kNearEnd * set_.Between(root, tip);
    const Coordinates inner = Sum(PlaceOf(tip, set_.scale()), kInset, set_.Way(tip, root));
    return std::ranges::any_of(ends_, [&](LatticePoint end) {
      return set_.Between(end, tip) < far && set_.Contains(end) &&
             Sees(PlaceOf(end, set_.scale()), inner);
    });
  }

  bool Sees(const Coordinates& from, const Coordinates& to) {
    const Coordinates way = Sum(to, -1, from);
    const double length = std::floor(LengthOf(way));
    return length == 0 || sections_.WayOut(from, Unit(way), 0, length) >= length;
  }

  // The points from the tip up the ridge of the depths to one beside the set; none if the ridge
  // leads elsewhere.
  std::vector<LatticePoint> WayFrom(LatticePoint tip, LatticePoint center) {
    std::vector<LatticePoint> way = {tip};
    const double most = kWayAround * set_.Between(tip, center) + kWayAroundUnits;
    double depth = depth_.At(tip);
    while (set_.NeighborsAround(way.back()) == 0) {
      const LatticePoint at = way.back();
      std::optional<LatticePoint> best;
      double best_score = 0, best_depth = 0;
      for (const LatticePoint offset : kDirections14) {
        const LatticePoint to = at + offset;
        const double from_tip = set_.Between(to, tip), left = set_.Between(to, center);
        if (from_tip + left > most || !bricks_.Contains(to)) continue;
        if (std::ranges::find(way, to) != way.end()) continue;
        const double length = set_.Between(at, to);
        const double toward = kToward * (set_.Between(at, center) - left) / length;
        const auto score = [&](double there) { return (there - depth) / length + toward; };
        if (best.has_value() && score(depth_.AtMost(to)) <= best_score) continue;
        const double there = depth_.At(to);
        if (best.has_value() && score(there) <= best_score) continue;
        best = to;
        best_score = score(there);
        best_depth = there;
      }
      if (!best.has_value()) return {};
      way.push_back(*best);
      depth = best_depth;
    }
    return way;
  }

  // Grows from the set along the way, which leads to it. Returns whether the path reaches the tip;
  // otherwise nothing changes.
  bool GrowAgainst(const std::vector<LatticePoint>& way) {
    const NeighborMask beside = set_.NeighborsAround(way.back());
    std::optional<LatticePoint> first;
    ForEachNeighbor(way.back(), beside, [&](LatticePoint q) { first = first.value_or(q); });
    const JunctionBall ball(set_, *first);
    if (!significance_.MayHaveBodyEnds(ball.radius())) return false;
    std::vector<std::pair<double, LatticePoint>> starts;
    for (const JunctionBall::Visited& visited : ball.visited()) {
      if (set_.Between(*first, visited.p) > kStartsAround * ball.radius()) continue;
      if (set_.IsEnd(visited.p)) return false;  // tips of limbs are placed later
      starts.emplace_back(set_.Between(visited.p, way.back()), visited.p);
    }
    std::ranges::sort(starts);
    if (starts.size() > kStartsTried) starts.resize(kStartsTried);
    std::vector<Coordinates> places;
    for (size_t n = way.size(); n-- > 0;) places.push_back(PlaceOf(way[n], set_.scale()));
    const auto may_add = [&](LatticePoint p) { return bricks_.Contains(p); };
    return std::ranges::any_of(starts, [&](const auto& start) {
      path_ = {start.second};
      return GrowAlong(places, 0, may_add, path_, set_);
    });
  }

  bool IsLimb() {
    if (path_.size() <= kLeastPoints) return false;
    const FreeBranch branch = BranchFrom(set_, path_.back());
    if (!branch.junction.has_value()) return false;
    return significance_.Of(set_, branch) >= threshold_ && IsRoundOutside();
  }

  // Whether the limb is round somewhere outside the ball at its root, unlike the corner of a face.
  bool IsRoundOutside() {
    const LatticePoint root = path_.front();
    const double radius = set_.RadiusOf(root), reach = JunctionBall::kExit * radius;
    const Coordinates way = Unit(set_.Way(root, path_.back()));
    for (size_t n = 0; n < path_.size(); n += kNextPlace) {
      const double depth = set_.RadiusOf(path_[n]);
      if (set_.Between(root, path_[n]) < reach || depth < kLeastDepthOfRoot * radius) continue;
      if (IsRound(path_[n], way, depth, kRoundLimb)) return true;
    }
    return false;
  }

  bool IsRound(LatticePoint p, const Coordinates& way, double radius, double most) {
    const CrossSection section =
        sections_.Across(PlaceOf(p, set_.scale()), way, radius, 2 * radius);
    return section.half_width <= most * radius + noise_.step;
  }

  ThinSet& set_;
  NearbyBricks bricks_;
  ExactRadius radius_;
  FirmDepth& depth_;
  CrossSections sections_;
  const SurfaceNoise noise_;
  Significance& significance_;
  const double threshold_;
  std::vector<LatticePoint> path_;   // from the set
  std::vector<LatticePoint> grown_;  // points of limbs
  std::vector<LatticePoint> ends_;   // of the set
};

}  // namespace

void GrowMissedLimbs(ThinSet& set, const PrunedObject& in, TipDepths& depths,
                     const SurfaceNoise& noise, Significance& significance, double threshold,
                     const exec::Context& context) {
  StopPoll poll(context);
  const PointTable<float> largest = LargestRadii(set, poll);
  const auto is_thick = [&](LatticePoint p) {
    const double radius = set.RadiusOf(p);
    return radius >= kThick * *largest.Find(p) && significance.MayHaveBodyEnds(radius);
  };
  double least = std::numeric_limits<double>::infinity();
  set.ForEachPoint([&](LatticePoint p) {
    if (is_thick(p)) least = std::min<double>(least, set.RadiusOf(p));
  });
  if (!(least < kMaxExtentCells) || poll.StoppedNow()) return;
  const auto edge = static_cast<int32_t>(std::bit_floor(static_cast<uint32_t>(least)));
  const BallGaps gaps(in.object, set, std::max(edge, kLeastEdge), poll);
  MissedLimbs limbs(set, in, depths.firm, noise, significance, threshold);
  std::vector<BallGaps::Peak> peaks = gaps.Peaks(least, kLeastGap, poll);
  std::ranges::sort(peaks, std::greater(),
                    [](const BallGaps::Peak& peak) { return std::pair(peak.gap, peak.tip); });
  for (const BallGaps::Peak& peak : peaks) {
    if (poll.StoppedNow()) return;
    if (largest.Find(peak.ball.center) != nullptr && is_thick(peak.ball.center)) limbs.GrowTo(peak);
  }
}

}  // namespace bccskel
