#include "core/pruning/tips.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/pruning/branch_walk.h"

namespace bccskel {
namespace {

// How much of the way along the limb a tip is worth. A box's corner, seen along the box, falls by 1
// like a round cap, the end of a pointed limb by less until its tip.
constexpr double kSlope = 0.75;
constexpr double kLeastGain = 0.5;   // a tip farther out is better by this, or noise has made it
constexpr double kAnchorRadii = 4;   // how far back the anchor lies, in radii
constexpr double kAnchorMargin = 5;  // and in lattice units
constexpr double kLeastAim = 4;      // from the anchor to what gives the limb its direction
constexpr double kCutRadii = 1.75;   // a cut takes the way into a cap or a corner at most, in radii
constexpr double kCutMargin = 6;     // and in lattice units: noise makes the radii smaller
constexpr size_t kHeadingPoints = 10;  // the way on is that of the last points
constexpr double kLeastCosine = 0.4;   // between the way on and a step
constexpr double kCosineWeight = 0.5;  // against the rise of the distance
constexpr float kLeastRadius = 2;      // in lattice units, of a tip
constexpr float kThickRadius = 6;      // limbs that reach it do not end in hair
constexpr double kPatience = 4;        // how far below the best a growing tip may fall

class TipPlacer {
 public:
  TipPlacer(ThinSet& set, ExactRadius& radius, const Volume& object, const PointSet& keep)
      : set_(set), radius_(radius), object_(object), keep_(keep) {}

  void Place(LatticePoint end) {
    if (!set_.Contains(end) || set_.Degree(end) != 1) return;
    FreeBranch branch = BranchFrom(set_, end);
    const std::optional<LatticePoint> anchor = TakeAnchor(branch);
    if (!anchor.has_value() || branch.points.empty()) return;
    anchor_ = *anchor;
    path_.assign(branch.points.rbegin(), branch.points.rend());
    CutHair();
    const size_t first = FirstCut();
    aim_ = set_.Between(anchor_, path_[first]) < kLeastAim ? path_.back() : path_[first];
    CutAfter(BestFrom(first));
    Extend();
    CutAfter(SafestFrom(first));
  }

 private:
  // Finds the anchor and leaves the points between the end and it.
  std::optional<LatticePoint> TakeAnchor(FreeBranch& branch) const {
    std::vector<LatticePoint>& points = branch.points;
    double length = 0;
    float radius = set_.RadiusOf(points[0]);
    for (size_t n = 1; n < points.size(); ++n) {
      length += set_.Between(points[n - 1], points[n]);
      radius = std::max(radius, set_.RadiusOf(points[n]));
      if (length < kAnchorRadii * radius + kAnchorMargin) continue;
      const LatticePoint anchor = points[n];
      points.resize(n);
      return anchor;
    }
    if (branch.junction.has_value()) return branch.junction;
    const LatticePoint middle = points[points.size() / 2];
    points.resize(points.size() / 2);
    return middle;
  }

  // How far p lies from the anchor along the limb, by the law of cosines.
  double Along(LatticePoint p) const {
    const double ap = set_.Between(anchor_, p), pq = set_.Between(p, aim_),
                 aq = set_.Between(anchor_, aim_);
    return (ap * ap + aq * aq - pq * pq) / (2 * aq);
  }

  double Merit(LatticePoint p) const { return kSlope * Along(p) + set_.RadiusOf(p); }

  // Position in the path of the point with the largest merit, on ties the farthest.
  size_t BestFrom(size_t first) const {
    size_t best = first;
    for (size_t n = first + 1; n < path_.size(); ++n) {
      if (Merit(path_[n]) >= Merit(path_[best])) best = n;
    }
    return best;
  }

  // Position in the path of the first point that is about as good as the best.
  size_t SafestFrom(size_t first) const {
    const double enough = Merit(path_[BestFrom(first)]) - kLeastGain;
    while (Merit(path_[first]) < enough) ++first;
    return first;
  }

  void CutAfter(size_t last) {
    while (path_.size() > last + 1 && !keep_.contains(path_.back())) {
      set_.Remove(path_.back());
      path_.pop_back();
    }
  }

  // In noise a thick limb may end in a path through the outermost points, where no tip is.
  void CutHair() {
    const auto radius = [this](LatticePoint p) { return set_.RadiusOf(p); };
    if (radius(*std::ranges::max_element(path_, {}, radius)) < kThickRadius) return;
    size_t last = path_.size() - 1;
    while (radius(path_[last]) < kLeastRadius) --last;
    CutAfter(last);
  }

  // Position in the path of the first point that may become the tip. What is cut off must lie in
  // the cap that the new tip is the center of: a body behind a short limb has a larger distance
  // than the limb, but the limb is no part of it.
  size_t FirstCut() const {
    size_t first = path_.size() - 1;
    while (first > 0 && set_.Between(path_.back(), path_[first - 1]) <=
                            kCutRadii * set_.RadiusOf(path_[first - 1]) + kCutMargin) {
      --first;
    }
    return first;
  }

  void Extend() {
    double best = Merit(path_.back());
    while (const std::optional<LatticePoint> next = NextTip()) {
      const float radius = radius_.At(*next);
      if (radius < kLeastRadius) break;
      set_.Add(*next, radius);
      path_.push_back(*next);
      const double merit = Merit(*next);
      if (merit < best - kPatience) break;
      best = std::max(best, merit);
    }
  }

  // The object point to go on to; its only neighbor in the set is the tip.
  std::optional<LatticePoint> NextTip() {
    const LatticePoint tip = path_.back();
    const LatticePoint from =
        path_.size() > kHeadingPoints ? path_[path_.size() - 1 - kHeadingPoints] : anchor_;
    std::optional<LatticePoint> best;
    double best_score = 0;
    for (const LatticePoint offset : kDirections14) {
      const LatticePoint next = tip + offset;
      const double cosine = Cosine(from, tip, next);
      if (cosine < kLeastCosine || !IsFreeWay(tip, next)) continue;
      const double rise = (radius_.At(next) - set_.RadiusOf(tip)) / set_.Between(tip, next);
      const double score = rise + kCosineWeight * cosine;
      if (best.has_value() && score <= best_score) continue;
      best = next;
      best_score = score;
    }
    return best;
  }

  bool IsFreeWay(LatticePoint tip, LatticePoint next) const {
    if (!object_.Contains(next) || set_.Contains(next)) return false;
    if (set_.Between(next, anchor_) <= set_.Between(tip, anchor_)) return false;
    return std::has_single_bit(set_.NeighborsAround(next));
  }

  // Between the ways a -> b and b -> c, by the law of cosines.
  double Cosine(LatticePoint a, LatticePoint b, LatticePoint c) const {
    const double ab = set_.Between(a, b), bc = set_.Between(b, c), ac = set_.Between(a, c);
    return (ac * ac - ab * ab - bc * bc) / (2 * ab * bc);
  }

  ThinSet& set_;
  ExactRadius& radius_;
  const Volume& object_;
  const PointSet& keep_;
  LatticePoint anchor_;
  LatticePoint aim_;                // the limb runs from the anchor to here
  std::vector<LatticePoint> path_;  // from the anchor, which is not part of it, to the tip
};

}  // namespace

void PlaceTips(ThinSet& set, ExactRadius& radius, const Volume& object, const PointSet& keep,
               const exec::Context& context) {
  TipPlacer placer(set, radius, object, keep);
  for (LatticePoint end : set.Ends()) {
    if (context.ShouldStop()) return;
    placer.Place(end);
  }
}

}  // namespace bccskel
