#ifndef BCCSKEL_CORE_PRUNING_LIMB_ANCHOR_H_
#define BCCSKEL_CORE_PRUNING_LIMB_ANCHOR_H_

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// The least length, in radii, from which a limb shows its direction.
inline constexpr double kLeastWayRadii = 0.5;

// Placing a tip removes at most a path into a cap or a corner: this many radii plus lattice units.
// The corners of a bar with three equal sides are sqrt(5) radii away.
inline constexpr double kCutRadii = 2.3;
inline constexpr double kCutMargin = 6;
// Where the radius falls by less than this per unit, the path certainly follows a ridge.
inline constexpr double kRidgeSlope = 0.3;
// Least distance from the anchor to the point that gives the limb its direction, in sampling steps.
inline constexpr double kLeastAim = 4;

// The point from which the direction of a limb is measured: four radii and 5 steps back from its
// end, or the junction, or where the ridge begins at the other end of a path without one. Where the
// limb bends, it lies no farther back than the limb is straight. Keeps the branch's points between
// its end and the anchor. Steps are the longest along an axis.
LatticePoint TakeAnchor(const ThinSet& set, FreeBranch& branch);

// The direction, of length 1, of an arc through the points of a limb, `ahead` units behind the last
// of them: there a limb cut flat has its face. The arc is the parabola of least squares. None if
// the points lie off it by more than `most_off` of its height (root mean square): then they are
// straight except for noise and the steps of the lattice, or form no arc.
// Shapes: `ahead` is in lattice units.
std::optional<Coordinates> DirectionOnArc(const ThinSet& set, std::span<const LatticePoint> points,
                                          double ahead, double most_off);

// The corner of a limb cut at a slant of up to 40 degrees lies no farther from the end of its ridge
// than this many radii there plus kCutMargin.
inline constexpr double kCornerRadii = 2.4;

// The straight continuation of a limb from the end of its ridge. All lengths are in lattice units.
struct WayOn {
  Coordinates way = {};                                   // of length 1
  double free = std::numeric_limits<double>::infinity();  // distance from it without penalty

  // The distance of a place from the continuation, less `free`, at least 0; 0 for places behind the
  // end of the ridge. The corner of a limb cut at a slant lies as far off as the limb is thick.
  // `to`: from the end of the ridge.
  double Aside(const Coordinates& to) const;
};
// The free distance is a quarter of the radius at the end of the ridge plus a unit. `way`: of any
// length but 0.
WayOn StraightOn(const Coordinates& way, double radius);
// The continuation in the direction of the last two radii of the path, at least four steps; in the
// direction from the anchor if the path is shorter. Without a penalty if even that is shorter than
// half the radius.
// Shapes: `path` comes from `anchor`, which is not part of it, and ends where the ridge ends.
WayOn WayOnFrom(const ThinSet& set, LatticePoint anchor, std::span<const LatticePoint> path);

// The end of a limb before its tip is placed.
struct LimbEnd {
  std::span<const LatticePoint> path;  // to the end
  size_t first = 0;                    // position in the path: no tip lies before
  LatticePoint straight;               // the last point that is certainly straight ahead
  double radius = 0;                   // median of the limb
};

// Position in the path of the end of a ridge that turns away from the limb's straight part, such as
// into a foot, and that no tip lies before; none if it does not.
// Does:  the ridge ends where the depth begins to fall by more than 0.3 per unit of the path. It
//        turns if that is more than 0.75 radii plus 2 units beyond the straight part. In a body
//        that is at least 1.4 times as thick as the limb, depths may fall by up to 0.45, as toward
//        the point of a pear, if the ridge then ends 1.2 of the body's radii plus 2 units from the
//        body's deepest point. (In limbs cut at a slant depths fall by 0.4 to 0.5 into the corner.)
std::optional<size_t> RidgeEndAside(const ThinSet& set, FirmDepth& depth, const LimbEnd& limb);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_LIMB_ANCHOR_H_
