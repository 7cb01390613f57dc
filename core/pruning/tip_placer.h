#ifndef BCCSKEL_CORE_PRUNING_TIP_PLACER_H_
#define BCCSKEL_CORE_PRUNING_TIP_PLACER_H_

#include <optional>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/pruning/ball_index.h"
#include "core/pruning/border_tips.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/bumps.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/flat_end.h"
#include "core/pruning/last_limb.h"
#include "core/pruning/limb_anchor.h"
#include "core/pruning/prune.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tip_steps.h"
#include "core/pruning/turned_tips.h"

namespace bccskel {

// What all tips of a skeleton have in common.
struct TipTask {
  const PrunedObject& in;
  const PointSet& keep;
  const SurfaceNoise& noise;
  const TurnedTips& turned;
  BallIndex balls;
};

// Places the tips of single branches (PlaceTips()).
// Threads: one thread per instance.
class TipPlacer {
 public:
  // Needs: what `task` refers to, and `depths` of its object, outlive this.
  TipPlacer(ThinSet& set, const TipTask& task, TipDepths& depths);

  // Does nothing if the point is no end of the set.
  void Place(LatticePoint end);
  // The points of curves that lead to cuts at the border, since the last call.
  PointsByAxis TakeAtBorder();

 private:
  // Finds where the limb begins, by its largest run: no tip lies before that.
  void FindRoot(const FreeBranch& branch);
  std::vector<float> RadiiOf(std::span<const LatticePoint> points) const;
  // Removes the tip that turns aside, so that the limb is extended straight on.
  void CutTurned(FreeBranch& branch, bool TurnedTips::Tip::*kind);
  // Leads the curve of a limb that the border of the image cuts off to the middle of its cut.
  bool LeadToBorder(const FreeBranch& branch);
  // In flat limbs the distance to the background does not show where the limb ends.
  bool CutFlat(const FreeBranch& branch);
  // Whether what follows sticks out: a limb of its own, whose path came through a flat body.
  bool IsLimbAfter(size_t position);
  // Position in the path.
  size_t NearestTo(const Coordinates& place) const;
  // Returns whether the limb grew along these places; otherwise nothing changed.
  bool GrowFrom(size_t from, std::span<const Coordinates> places);

  double Along(LatticePoint p) const;
  double Aside(LatticePoint p) const;
  double Merit(LatticePoint p, double slope = kTipSlope);
  // An upper bound of Merit(), also in floating point, where sums and products are monotonic.
  double MeritAtMost(LatticePoint p, double slope = kTipSlope) const;
  // Position in the path of the point with the largest merit, on ties the farthest.
  size_t BestFrom(size_t first, double slope = kTipSlope);
  // Position in the path of the first point that is about as good as the best.
  size_t SafestFrom(size_t first);
  void CutAfter(size_t last);
  // A point in the direction of the limb from the anchor, not so near that the lattice decides: the
  // first that may become the tip, or the last on the ridge, behind which the path may turn.
  LatticePoint AimFrom(size_t first);
  // Whether the limb narrows toward its end. On a surface that is not smooth, single points there
  // may be noise.
  bool HasPoint() const;
  // On a noisy surface the path may end in single points, which are no tip.
  void CutBumps();
  // Position in the path of the first point that may become the tip. The end must lie in the cap
  // around the new tip, and the new tip must lie in the limb, not in a body behind a short limb or
  // in a bead, whose distances are larger.
  size_t FirstCut(double radii);
  // Whether p lies in the ball of the junction.
  bool IsInJunction(LatticePoint p) const;
  // Whether the end lies in the cap around p. The depth is at least the radius, so testing the
  // radius is usually enough. In the ball of the junction, the distances rise toward the body and
  // not along the limb, unless the limb is an end of the body, whose cap p's ball holds.
  bool IsInCapOf(LatticePoint p, double radii);
  // Position in the path, at least `n`, of a point from which the way ahead is known.
  size_t FirstThatShowsWay(size_t n) const;
  // Thinning may leave the ridge before the limb ends, so the path is grown again from the last
  // point that is certainly on the ridge. Single points do not grow. Returns the position in the
  // path of the first point that may become the tip.
  size_t GrowAnew(size_t first);
  // Position in the path of the end of a limb that bends as it narrows to a point: as far as the
  // object is round across the path, which then leads into no corner. None for other limbs, and if
  // that is no farther beyond `straight`, up to which the path is certainly on the ridge, than a
  // cap is long.
  std::optional<size_t> PointedEnd(size_t first, size_t straight);
  // Whether a path that turns aside from the position `straight` may lead into a corner of a limb
  // that is cut square: its ball at `end` reaches no farther, it narrows, and the object is not
  // round across it.
  bool MayLeadIntoCorner(size_t straight, size_t end);
  // Whether, of eight places between the positions, at least three are round and at most one is
  // not. Places too thin to tell do not count. Needs: first <= last.
  bool IsRoundBetween(size_t first, size_t last);
  bool IsRoundAt(size_t n);
  // A bent limb has turned away from the direction in which it left its anchor. Returns whether it
  // is bent.
  bool FollowBend();
  void Extend();
  bool IsInBallOfAnother(LatticePoint p) const;
  // Its radius is measured later, since most points are removed again.
  void Append(LatticePoint p);
  void MeasureGrown();

  ThinSet& set_;
  NearbyBricks bricks_;
  Bumps bumps_;
  ExactRadius radius_;
  FirmDepth& depth_;
  TipSteps steps_;
  CrossSections sections_;
  FlatEnd flat_;
  LastLimb last_limb_;
  std::optional<BorderTips> border_tips_;
  const PointSet& keep_;
  const TurnedTips& turned_;
  BallIndex balls_;
  const AxisScale scale_;
  const double step_;  // the longest step along an axis, in lattice units
  const double least_gain_;
  const SurfaceNoise noise_;
  std::optional<LatticePoint> junction_;  // of the branch
  std::vector<LatticePoint> own_;         // its points
  LatticePoint root_;                     // where the limb begins; it may be cut off
  double root_radius_ = 0;
  double limb_radius_ = 0;  // median
  LatticePoint anchor_;
  LatticePoint origin_;             // of the way along the limb
  Coordinates direction_ = {};      // of the limb's end, of length 1
  LatticePoint ridge_end_;          // the last point that is certainly on the ridge
  WayOn way_on_;                    // from there
  std::vector<LatticePoint> path_;  // from the anchor, which is not part of it, to the tip
  PointsByAxis at_border_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TIP_PLACER_H_
