#ifndef BCCSKEL_CORE_PRUNING_RIDGE_END_H_
#define BCCSKEL_CORE_PRUNING_RIDGE_END_H_

#include <cstddef>
#include <optional>
#include <span>

#include "core/lattice/lattice_point.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

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

#endif  // BCCSKEL_CORE_PRUNING_RIDGE_END_H_
