#include "core/pruning/grow_body_ends.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/stop_poll.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/junction_ball.h"
#include "core/pruning/point_table.h"
#include "core/pruning/tip_steps.h"

namespace bccskel {
namespace {

constexpr double kStart = 0.4;  // largest distance of a start from the center, in the ball's radii
constexpr size_t kMostStarts = 16;       // tried at a junction
constexpr double kGrowth = 2.5;          // longest end, in radii of the ball
constexpr double kGrowthUnits = 6;       // plus lattice units
constexpr double kOnTheWay = 0.9;        // cosine: a limb this straight ahead continues the body
constexpr double kBeside = 0.5;          // cosine: limbs in this cone must be thinner
constexpr double kThinnerBeside = 0.75;  // their largest radius, in radii of the end
constexpr double kStraight = 0.75;       // least cosine of the end at its exit
constexpr double kLeastDepth = 0.35;     // least depth there, in radii of the ball
constexpr double kLeastTurning = 1.5;    // least radius of a body there, as for MayHaveBodyEnds()
// Where a curve turns from a body into a limb, in radii of the body: the limb's largest radius at
// its exit, and the least radii of the turn and of the body at the other exit.
constexpr double kThinnerAhead = 0.7, kAboutAsThick = 0.92, kThickBehind = 0.85;

// Where a body may have an end: at a junction, or where a curve turns from it into a limb.
struct Place {
  LatticePoint center;
  bool is_turn = false;
  std::optional<LatticePoint> limb;  // the end to which the curve turns, if it is free
};

class BodyEnds {
 public:
  BodyEnds(ThinSet& set, const PrunedObject& in, FirmDepth& depth, Significance& significance,
           double threshold)
      : set_(set),
        radius_(in.radius),
        depth_(depth),
        steps_(set, in.object, depth),
        significance_(significance),
        threshold_(threshold) {}

  // Returns whether an end grew; otherwise nothing changed.
  bool GrowAt(const Place& place) {
    const LatticePoint junction = place.center;
    const JunctionBall ball(set_, junction);
    if (ball.exits().empty()) return false;
    const LatticePoint body = ball.visited()[ball.body()].p;
    const Coordinates on = Unit(set_.Way(body, junction));
    double beside = 0;
    for (size_t exit : ball.exits()) {
      const LatticePoint p = ball.visited()[exit].p;
      const double cosine = Dot(on, Unit(set_.Way(junction, p)));
      if (cosine > kOnTheWay) return false;
      if (cosine > kBeside) beside = std::max<double>(beside, set_.RadiusOf(p));
    }
    for (size_t start : StartsIn(ball, on)) {
      path_ = ball.WayTo(start);
      own_ = path_.size();
      const bool left = Follow(ball, on, beside, body);
      if (left && IsSignificant(place) && LeavesALimb(place)) {
        MeasureGrown();
        return true;
      }
      CutTo(own_);
      if (left) return false;  // other starts lead to the same ridge
    }
    return false;
  }

 private:
  // Points near the center, the farthest ahead first: near it others are beside other branches.
  std::vector<size_t> StartsIn(const JunctionBall& ball, const Coordinates& on) const {
    const LatticePoint center = ball.visited()[0].p;
    std::vector<std::pair<double, size_t>> starts;
    for (size_t n = 0; n < ball.visited().size(); ++n) {
      const Coordinates way = set_.Way(center, ball.visited()[n].p);
      if (Dot(way, way) > kStart * kStart * ball.radius() * ball.radius()) continue;
      starts.emplace_back(-Dot(on, way), n);
    }
    std::ranges::sort(starts);
    if (starts.size() > kMostStarts) starts.resize(kMostStarts);
    std::vector<size_t> indices;
    for (const auto& [behind, n] : starts) indices.push_back(n);
    return indices;
  }

  // Extends the path along the ridge to its end; not at all if it does not leave the ball as the
  // end of a body. Returns whether it leaves the ball.
  bool Follow(const JunctionBall& ball, const Coordinates& on, double beside, LatticePoint body) {
    const LatticePoint center = path_.front();
    double best = 0;
    size_t last = own_;
    bool left = false;
    while (const std::optional<LatticePoint> next = steps_.Next(path_, body)) {
      const double way = set_.Between(center, *next), depth = depth_.At(*next);
      if (way > kGrowth * ball.radius() + kGrowthUnits) break;
      if (significance_.IsCovered(set_, path_, *next, depth)) return false;
      if (!left && way >= ball.reach()) {
        left = true;
        const double cosine = Dot(on, Unit(set_.Way(center, *next)));
        const double least = std::max(kLeastDepth * ball.radius(), beside / kThinnerBeside);
        if (depth < least || cosine < kStraight) {
          last = own_;
          break;
        }
      }
      set_.Add(*next, static_cast<float>(depth));
      path_.push_back(*next);
      const double merit = depth + kTipSlope * way;
      if (merit < best - kTipPatience) break;
      if (merit > best) best = merit, last = path_.size();
    }
    CutTo(last);
    return left;
  }

  bool IsSignificant(const Place& place) {
    if (path_.size() == own_) return false;
    using BodyAt = Significance::BodyAt;
    const BodyAt at = place.is_turn ? BodyAt::kTurn : BodyAt::kJunction;
    const FreeBranch branch = BranchFrom(set_, path_.back());
    return branch.junction.has_value() && significance_.OfBodyEnd(set_, branch, at) >= threshold_;
  }

  // Else the curve only turned into a corner of the end.
  bool LeavesALimb(const Place& place) {
    if (!place.limb.has_value()) return true;
    const FreeBranch limb = BranchFrom(set_, *place.limb);
    return !limb.junction.has_value() || significance_.Of(set_, limb) >= threshold_;
  }

  void CutTo(size_t size) {
    for (; path_.size() > size; path_.pop_back()) set_.Remove(path_.back());
  }

  void MeasureGrown() {
    for (size_t n = own_; n < path_.size(); ++n) set_.SetRadius(path_[n], radius_.At(path_[n]));
  }

  ThinSet& set_;
  ExactRadius radius_;
  FirmDepth& depth_;
  TipSteps steps_;
  Significance& significance_;
  const double threshold_;
  std::vector<LatticePoint> path_;  // from the junction
  size_t own_ = 0;                  // of the path, the points that were there before
};

// The points of a junction; none for a surface, which is followed no farther than to a part that
// was seen before. `in_surface`: for each point seen, whether it is part of a surface.
std::vector<LatticePoint> JunctionAt(LatticePoint p, const ThinSet& set,
                                     PointTable<char>& in_surface) {
  std::vector<LatticePoint> points = {p};
  in_surface.Set(p, 0);
  bool is_surface = false;
  for (size_t n = 0; n < points.size() && !is_surface; ++n) {
    ForEachNeighbor(points[n], set.NeighborsOf(points[n]), [&](LatticePoint q) {
      if (is_surface || !set.Branches(q)) return;
      if (const char* seen = in_surface.Find(q); seen != nullptr) {
        is_surface = *seen != 0;
        return;
      }
      in_surface.Set(q, 0);
      points.push_back(q);
      is_surface = points.size() >= kMostClusterPoints;
    });
  }
  if (!is_surface) return points;
  for (LatticePoint q : points) in_surface.Set(q, 1);
  return {};
}

// The deepest point of each junction, of those in balls that are large enough.
std::vector<Place> JunctionsOf(const ThinSet& set, const Significance& significance,
                               StopPoll& poll) {
  std::vector<LatticePoint> points;
  std::vector<Place> deepest;
  set.ForEachPoint([&](LatticePoint p) {
    const bool may = set.Branches(p) && significance.MayHaveBodyEnds(set.RadiusOf(p));
    if (!poll.Stopped() && may) points.push_back(p);
  });
  std::ranges::sort(points);
  PointTable<char> in_surface;
  for (LatticePoint p : points) {
    if (poll.Stopped()) break;
    if (in_surface.Find(p) != nullptr) continue;
    const std::vector<LatticePoint> junction = JunctionAt(p, set, in_surface);
    if (junction.empty()) continue;
    const auto radius = [&](LatticePoint q) { return set.RadiusOf(q); };
    deepest.push_back({*std::ranges::max_element(junction, {}, radius), false, std::nullopt});
  }
  return deepest;
}

// The points of a curve at which it turns from a body into a thinner limb: the last ones that are
// about as thick as the body. The curve leads away from the body.
void AddTurnsOf(std::span<const LatticePoint> curve, const ThinSet& set,
                const Significance& significance, std::vector<Place>& turns) {
  const auto may_turn = [&](LatticePoint p) {
    return significance.MayHaveBodyEnds(set.RadiusOf(p), kLeastTurning);
  };
  if (std::ranges::none_of(curve, may_turn)) return;
  const LatticePoint end = curve.back();
  const auto limb = set.IsEnd(end) ? std::optional(end) : std::nullopt;
  const auto exit_at = [&](size_t n, size_t exit) {
    return set.Between(curve[n], curve[exit]) >= JunctionBall::kExit * set.RadiusOf(curve[n]);
  };
  size_t exit = 1;
  for (size_t n = 0; n < curve.size(); ++n) {
    const double body = set.RadiusOf(curve[n]);
    exit = std::max(exit, n + 1);
    while (exit < curve.size() && !exit_at(n, exit)) ++exit;
    if (exit == curve.size()) break;
    if (!may_turn(curve[n])) continue;
    if (set.RadiusOf(curve[exit]) > kThinnerAhead * body) continue;
    size_t last = n;
    while (set.RadiusOf(curve[last + 1]) >= kAboutAsThick * body) ++last;
    size_t before = last;
    while (before > 0 && !exit_at(last, before)) --before;
    const bool from_body = exit_at(last, before) &&
                           set.RadiusOf(curve[before]) >= kThickBehind * set.RadiusOf(curve[last]);
    if (from_body) turns.push_back({curve[last], true, limb});
    n = exit;
  }
}

void AddTurns(const ThinSet& set, const Significance& significance, StopPoll& poll,
              std::vector<Place>& turns) {
  std::vector<LatticePoint> starts;
  set.ForEachPoint([&](LatticePoint p) {
    if (!poll.Stopped() && !IsCurvePoint(set.NeighborsOf(p))) starts.push_back(p);
  });
  std::ranges::sort(starts);
  std::vector<LatticePoint> curve;
  for (LatticePoint start : starts) {
    if (poll.Stopped(1 + curve.size())) return;
    curve.clear();
    ForEachNeighbor(start, set.NeighborsOf(start), [&](LatticePoint next) {
      if (!IsCurvePoint(set.NeighborsOf(next))) return;
      curve = {start};
      curve.push_back(FollowCurve(set, start, next, curve));
      AddTurnsOf(curve, set, significance, turns);
    });
  }
}

// Grows ends in a set that other workers read, too: each as if it were the first.
class Trial {
 public:
  Trial(int worker, const ThinSet& set, const PrunedObject& in, TipDepths& depths,
        const Significance& significance, double threshold)
      : set_(ThinSet::Over(set)),
        depths_(worker, depths, in.WhereDepthsAre(), in.radius),
        significance_(significance),
        ends_(set_, in, depths_->firm, significance_, threshold) {}

  std::vector<ThinSet::Change> GrowAt(const Place& place) {
    const bool grew = ends_.GrowAt(place);
    std::vector<ThinSet::Change> changes = set_.TakeChanges();
    return grew ? std::move(changes) : std::vector<ThinSet::Change>();
  }

 private:
  ThinSet set_;
  DepthsOfWorker depths_;
  Significance significance_;
  BodyEnds ends_;
};

}  // namespace

void GrowBodyEnds(ThinSet& set, const PrunedObject& in, TipDepths& depths,
                  Significance& significance, double threshold, const exec::Context& context) {
  StopPoll poll(context);
  std::vector<Place> places = JunctionsOf(set, significance, poll);
  AddTurns(set, significance, poll, places);
  if (places.empty() || context.ShouldStop()) return;
  std::vector<std::vector<ThinSet::Change>> grown(places.size());
  const int workers = context.WorkersFor(places.size(), Significance::kWork);
  (void)context.ForEach(workers, places.size(), 1, [&](int worker) {
    return [&, trial = Trial(worker, set, in, depths, significance, threshold)](size_t n) mutable {
      grown[n] = trial.GrowAt(places[n]);
    };
  });
  std::optional<BodyEnds> ends;
  for (size_t n = 0; n < places.size(); ++n) {
    if (context.ShouldStop()) return;
    if (set.Apply(grown[n])) continue;
    if (!ends.has_value()) ends.emplace(set, in, depths.firm, significance, threshold);
    ends->GrowAt(places[n]);
  }
}

}  // namespace bccskel
