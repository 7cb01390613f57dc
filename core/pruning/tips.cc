#include "core/pruning/tips.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/distance/places.h"
#include "core/pruning/ball_index.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/flat_end.h"
#include "core/pruning/grow_along.h"
#include "core/pruning/largest_run.h"
#include "core/pruning/last_limb.h"
#include "core/pruning/limb_anchor.h"
#include "core/pruning/pruning_defaults.h"

namespace bccskel {
namespace {

// Weight of the distance along the limb in a tip's merit. Toward a box's corner or the end of a
// round cap the radius falls by 1 per unit, toward the tip of a pointed limb by less.
constexpr double kSlope = 0.75;
constexpr double kGainBySteps = 0.42;  // a tip farther out is better by so many surface steps
constexpr double kGainByNoise = 0.06;  // and this share of the noise allowance, or noise made it
constexpr double kAimRadii = 1.75;     // as kCutRadii, for the point that shows the direction
constexpr double kHairLength = 6;  // in lattice units; longer ends of single points are thin limbs,
constexpr double kHairRadii = 2;   // and what is longer by the limb's radius
constexpr size_t kHeadingPoints = 10;  // whose direction is the way ahead
constexpr double kLeastCosine = 0.4;   // between the way ahead and a step
constexpr double kCosineWeight = 0.5;  // against the rise of the distance
constexpr double kGrowthRadii = 2;   // of the limb's root: how far tips grow, as to a cone's point,
constexpr double kGrowthMargin = 6;  // and lattice units
constexpr double kLongStep = 2;  // on lattices with longer steps by one radius: caps are too coarse
constexpr double kOffArc = 0.25;  // of its points from the arc of a bent limb, of its height
constexpr double kOffArcAtRoot = kOffArc / 2;  // where the arc begins with the limb
constexpr double kPatience = 4;                // how far below the best a growing tip may fall
constexpr int kMajority = 7;                   // of 14 neighbors, with the point itself
constexpr int kThinner = 3;  // in thin limbs: so many fewer than their points have

class TipPlacer {
 public:
  TipPlacer(ThinSet& set, const Volume& object, const Volume& space, const ExactRadius& radius,
            const PointSet& keep, const SurfaceNoise& noise, const TurnedTips& turned,
            const exec::Context& context)
      : set_(set),
        bricks_(object),
        radius_(radius),
        searching_(radius.searches() ? radius : ExactRadius(space)),
        depth_(space, searching_),
        flat_(object, searching_, depth_),  // it ends at the border
        last_limb_(object, noise),
        keep_(keep),
        turned_(turned),
        balls_(set, AxisScaleOf(object.placement()), context),
        step_(std::ranges::max(AxisScaleOf(object.placement()))),
        least_gain_(kGainBySteps * noise.step + kGainByNoise * noise.thin),
        noise_(noise) {}

  void Place(LatticePoint end) {
    if (!set_.Contains(end) || set_.Degree(end) != 1) return;
    FreeBranch branch = BranchFrom(set_, end);
    FindRoot(branch);
    if (CutFlat(branch)) return;
    CutTurned(branch);
    anchor_ = TakeAnchor(set_, step_, branch);
    if (branch.points.empty()) return;
    path_.assign(branch.points.rbegin(), branch.points.rend());
    FindMajority();
    CutHair();
    origin_ = anchor_;
    way_on_ = {};
    direction_ = Unit(set_.Way(anchor_, AimFrom(FirstCut(kAimRadii))));
    const size_t first = FirstCut(kCutRadii);
    GrowAnew(first);
    CutAfter(SafestFrom(first));
    MeasureGrown();
  }

 private:
  // Finds where the limb begins, by its largest run: no tip lies before that.
  void FindRoot(const FreeBranch& branch) {
    BranchPath path{{branch.points.rbegin(), branch.points.rend()}, {}};
    std::vector<LatticePoint>& points = path.points;
    junction_ = branch.junction;
    own_ = points;
    if (junction_.has_value()) {
      points.insert(points.begin(), *junction_);
    } else {
      points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2));
    }
    for (LatticePoint p : points) path.radii.push_back(set_.RadiusOf(p));
    root_ = points[0];
    if (points.size() >= 2) {
      const Run run = LargestRun(set_, path, noise_);
      if (run.ratio >= WithDefaults({}).threshold) root_ = points[run.from];
    }
    root_radius_ = set_.RadiusOf(root_);
  }

  // Removes the tip that turns aside, so that the limb is extended straight on.
  void CutTurned(FreeBranch& branch) {
    const std::span<const LatticePoint> turned = turned_.At(branch.points);
    const auto is_kept = [&](LatticePoint p) { return keep_.contains(p); };
    if (turned.empty() || std::ranges::any_of(turned, is_kept)) return;
    for (LatticePoint p : turned) set_.Remove(p);
    branch = BranchFrom(set_, branch.points[turned.size()]);
    FindRoot(branch);
  }

  // In flat limbs the distance to the background does not show where they end.
  bool CutFlat(const FreeBranch& branch) {
    path_.assign(branch.points.rbegin(), branch.points.rend());
    const auto root = std::ranges::find(path_, root_);
    if (root != path_.end()) path_.erase(path_.begin(), root);
    const std::optional<FlatEnd::Tip> tip = flat_.In(path_, set_);
    if (!tip.has_value()) return false;
    if (!GrowInFlat(*tip)) CutAfter(tip->last);
    MeasureGrown();
    return true;
  }

  // Returns whether the limb grew along its middle; otherwise nothing changed.
  bool GrowInFlat(const FlatEnd::Tip& tip) {
    const auto behind = std::span(path_).subspan(tip.from + 1);
    const auto is_kept = [&](LatticePoint p) { return keep_.contains(p); };
    if (tip.middle.size() < 2 || std::ranges::any_of(behind, is_kept)) return false;
    balls_.SetOwn(own_);
    const auto may_add = [&](LatticePoint p) {
      return bricks_.Contains(p) && !IsInBallOfAnother(p);
    };
    return GrowAlong(tip.middle, tip.from, may_add, path_, set_);
  }

  double Along(LatticePoint p) const { return Dot(direction_, set_.Way(origin_, p)); }

  double Aside(LatticePoint p) const { return way_on_.Aside(set_.Way(ridge_end_, p)); }

  double Merit(LatticePoint p, double slope = kSlope) {
    return slope * Along(p) - Aside(p) + depth_.At(p);
  }
  // An upper bound of Merit(), also in floating point, where sums and products are monotonic.
  double MeritAtMost(LatticePoint p, double slope = kSlope) const {
    return slope * Along(p) - Aside(p) + depth_.AtMost(p);
  }

  // Position in the path of the point with the largest merit, on ties the farthest.
  size_t BestFrom(size_t first, double slope = kSlope) {
    size_t best = path_.size() - 1;
    double most = Merit(path_[best], slope);
    for (size_t n = best; n-- > first;) {
      if (MeritAtMost(path_[n], slope) <= most || Merit(path_[n], slope) <= most) continue;
      best = n;
      most = Merit(path_[n], slope);
    }
    return best;
  }

  // Position in the path of the first point that is about as good as the best.
  size_t SafestFrom(size_t first) {
    const double enough = Merit(path_[BestFrom(first)]) - least_gain_;
    while (MeritAtMost(path_[first]) < enough || Merit(path_[first]) < enough) ++first;
    return first;
  }

  void CutAfter(size_t last) {
    while (path_.size() > last + 1 && !keep_.contains(path_.back())) {
      set_.Remove(path_.back());
      path_.pop_back();
    }
  }

  // A point in the direction of the limb from the anchor, not so near that the lattice decides: the
  // first that may become the tip, or the last on the ridge, behind which the path may turn.
  LatticePoint AimFrom(size_t first) {
    const double least = kLeastAim * step_;
    if (set_.Between(anchor_, path_[first]) >= least) return path_[first];
    LatticePoint aim = path_.back();
    double most = 0;
    for (size_t n = first; n < path_.size(); ++n) {
      const double way = set_.Between(anchor_, path_[n]);
      const double merit = kRidgeSlope * way + set_.RadiusOf(path_[n]);
      if (way < least || merit <= most) continue;
      most = merit;
      aim = path_[n];
    }
    return aim;
  }

  int NeighborsOf(LatticePoint p) {
    return static_cast<int>(std::ranges::count_if(
        kDirections14, [&](LatticePoint offset) { return bricks_.Contains(p + offset); }));
  }

  // Thin limbs have no points with many neighbors near their tips.
  void FindMajority() {
    std::vector<float> counts;
    for (LatticePoint p : path_) counts.push_back(static_cast<float>(NeighborsOf(p)));
    majority_ = std::clamp(static_cast<int>(MedianOf(counts)) - kThinner, kThinner, kMajority);
  }

  // Whether p takes the side of the majority.
  bool IsFirm(LatticePoint p) { return NeighborsOf(p) >= majority_; }

  // On a noisy surface the path may end in single points, which are no tip.
  void CutHair() {
    size_t last = path_.size() - 1;
    while (last > 0 && !IsFirm(path_[last])) --last;
    const double length = set_.Between(path_[last], path_.back());
    std::vector<float> radii;
    for (LatticePoint p : path_) radii.push_back(set_.RadiusOf(p));
    const double longest = std::min<double>(kHairLength, kHairRadii * MedianOf(std::move(radii)));
    if (IsFirm(path_[last]) && length <= longest) CutAfter(last);
  }

  // Position in the path of the first point that may become the tip. The end must lie in the cap
  // around the new tip, and the new tip must lie in the limb, not in a body behind a short
  // limb or in a bead, whose distances are larger.
  size_t FirstCut(double radii) {
    size_t first = path_.size() - 1;
    for (size_t n = first; n > 0 && path_[n] != root_; --n) {
      if (IsInCapOf(path_[n - 1], radii)) first = n - 1;
    }
    return last_limb_.BeginIn(set_, path_, first);
  }

  // The depth is at least the radius, so testing the radius is usually enough.
  bool IsInCapOf(LatticePoint p, double radii) {
    const double way = set_.Between(path_.back(), p);
    return way <= radii * set_.RadiusOf(p) + kCutMargin || way <= radii * depth_.At(p) + kCutMargin;
  }

  // Thinning may leave the ridge before the limb ends, so the path is grown again from the last
  // point that is certainly on the ridge. Single points do not grow.
  void GrowAnew(size_t first) {
    if (!IsFirm(path_.back())) return;
    CutAfter(BestFrom(first, kRidgeSlope));
    ridge_end_ = path_.back();
    WayOn on = WayOnFrom(set_, step_, anchor_, path_);
    if (FollowBend()) on.way = direction_;
    Extend();
    const double corner = kCornerRadii * set_.RadiusOf(ridge_end_) + kCutMargin;
    if (set_.Between(ridge_end_, path_.back()) <= corner) way_on_ = on;
  }

  // A bent limb has turned away from the direction in which it left its anchor. Returns whether it
  // is bent.
  bool FollowBend() {
    std::vector<LatticePoint> limb = {anchor_};
    limb.insert(limb.end(), path_.begin(), path_.end());
    const auto root = std::ranges::find(limb, root_);
    const double most_off = root == limb.end() ? kOffArc : kOffArcAtRoot;
    if (root != limb.end()) limb.erase(limb.begin(), root);
    const std::optional<Coordinates> bent =
        DirectionOnArc(set_, limb, set_.RadiusOf(limb.back()), most_off);
    if (!bent.has_value()) return false;
    origin_ = limb.back();
    direction_ = *bent;
    return true;
  }

  void Extend() {
    balls_.SetOwn(own_);
    double best = Merit(path_.back());
    const LatticePoint start = path_.back();
    const double radii = step_ < kLongStep ? kGrowthRadii : 1;
    const double longest = radii * root_radius_ + kGrowthMargin;
    while (const std::optional<LatticePoint> next = NextTip()) {
      if (!IsFirm(*next) || set_.Between(*next, start) > longest || IsInBallOfAnother(*next)) break;
      Append(*next);
      const double merit = Merit(*next);
      if (merit < best - kPatience) break;
      best = std::max(best, merit);
    }
  }

  bool IsInBallOfAnother(LatticePoint p) const {
    return junction_.has_value() && balls_.IsCovered(p, set_.Between(p, *junction_), set_);
  }

  // Its radius is measured later, since most points are removed again.
  void Append(LatticePoint p) {
    set_.Add(p, 0);
    path_.push_back(p);
  }

  void MeasureGrown() {
    for (size_t n = path_.size(); n > 0 && set_.RadiusOf(path_[n - 1]) == 0; --n) {
      set_.SetRadius(path_[n - 1], radius_.At(path_[n - 1]));
    }
  }

  // A candidate for the next point.
  struct Step {
    LatticePoint to;
    size_t rank = 0;
    double length = 0;
    double straightness = 0;  // its part of the score
    double score_most = 0;    // the score is no more
  };

  // The next object point, the first of the best; its only neighbor in the set is the tip. Finding
  // depths is slow, so the most promising steps come first and rule out most others.
  std::optional<LatticePoint> NextTip() {
    const double depth = depth_.At(path_.back());
    const Step* best = nullptr;
    double best_score = 0;
    FindSteps(depth);
    for (const Step& step : steps_) {
      if (best != nullptr && step.score_most < best_score) break;
      const double score = (depth_.At(step.to) - depth) / step.length + step.straightness;
      const bool is_better =
          best == nullptr || score > best_score || (score == best_score && step.rank < best->rank);
      if (!is_better) continue;
      best = &step;
      best_score = score;
    }
    return best == nullptr ? std::nullopt : std::optional(best->to);
  }

  void FindSteps(double depth) {
    const LatticePoint tip = path_.back();
    const LatticePoint from =
        path_.size() > kHeadingPoints ? path_[path_.size() - 1 - kHeadingPoints] : anchor_;
    steps_.clear();
    for (size_t rank = 0; rank < kDirections14.size(); ++rank) {
      const LatticePoint to = tip + kDirections14[rank];
      const double cosine = Cosine(from, tip, to);
      if (cosine < kLeastCosine || !IsFreeWay(tip, to)) continue;
      const double length = set_.Between(tip, to), straightness = kCosineWeight * cosine;
      const double score_most = (depth_.AtMost(to) - depth) / length + straightness;
      steps_.push_back({to, rank, length, straightness, score_most});
    }
    std::ranges::sort(steps_, std::ranges::greater(), &Step::score_most);
  }

  bool IsFreeWay(LatticePoint tip, LatticePoint next) {
    if (!bricks_.Contains(next) || set_.Contains(next)) return false;
    if (set_.Between(next, anchor_) <= set_.Between(tip, anchor_)) return false;
    return std::has_single_bit(set_.NeighborsAround(next));
  }

  // Between the ways a -> b and b -> c, by the law of cosines.
  double Cosine(LatticePoint a, LatticePoint b, LatticePoint c) const {
    const double ab = set_.Between(a, b), bc = set_.Between(b, c), ac = set_.Between(a, c);
    return (ac * ac - ab * ab - bc * bc) / (2 * ab * bc);
  }

  ThinSet& set_;
  NearbyBricks bricks_;
  ExactRadius radius_;
  const ExactRadius searching_;
  FirmDepth depth_;
  FlatEnd flat_;
  LastLimb last_limb_;
  const PointSet& keep_;
  const TurnedTips& turned_;
  BallIndex balls_;
  const double step_;  // the longest step along an axis, in lattice units
  const double least_gain_;
  const SurfaceNoise noise_;
  std::optional<LatticePoint> junction_;  // of the branch
  std::vector<LatticePoint> own_;         // its points
  LatticePoint root_;                     // where the limb begins; it may be cut off
  double root_radius_ = 0;
  int majority_ = kMajority;  // in this limb
  LatticePoint anchor_;
  LatticePoint origin_;             // of the way along the limb
  Coordinates direction_ = {};      // of the limb's end, of length 1
  LatticePoint ridge_end_;          // the last point that is certainly on the ridge
  WayOn way_on_;                    // from there
  std::vector<LatticePoint> path_;  // from the anchor, which is not part of it, to the tip
  std::vector<Step> steps_;         // from the tip, the most promising first
};

}  // namespace

absl::Status PlaceTips(ThinSet& set, const Volume& object, const Volume& space,
                       const ExactRadius& radius, const PointSet& keep, const SurfaceNoise& noise,
                       const TurnedTips& turned, const exec::Context& context) {
  const std::vector<LatticePoint> ends = set.Ends();
  if (ends.empty()) return absl::OkStatus();
  TipPlacer placer(set, object, space, radius, keep, noise, turned, context);
  for (LatticePoint end : ends) {
    if (context.ShouldStop()) return context.StopStatus();
    placer.Place(end);
  }
  return absl::OkStatus();
}

}  // namespace bccskel
