#ifndef BCCSKEL_CORE_PRUNING_TIPS_H_
#define BCCSKEL_CORE_PRUNING_TIPS_H_

#include "absl/status/status.h"
#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/turned_tips.h"
#include "core/volume/volume.h"

namespace bccskel {

// Cuts every branch back, or extends it, to the end of its limb: the place with the largest sum of
// the distance to the background and 0.75 of the distance along the limb minus that beside its
// way (README.md of this folder); for flat limbs, see flat_end.h. Distances are measured without
// pits, and no tip lies on a bump (Denoise()). A tip is never cut back beyond where its
// limb begins (LargestRun(), LastLimb) or turns. It grows by at most twice the radius there plus 6
// units (once where steps along an axis are twice as long as others), and not into the ball of
// another branch. Points of `keep` are not cut off. What turns aside at the ends of limbs that are
// not flat is removed first (TurnedTips).
// Needs:  `radius` belongs to `object`; `searching` searches, and `depth` belongs to the object or
// to
//         it with points beyond its border, into which no tip grows. `noise` is that of its
//         surface.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::Status PlaceTips(ThinSet& set, const Volume& object, const ExactRadius& radius,
                       const ExactRadius& searching, FirmDepth& depth, const PointSet& keep,
                       const SurfaceNoise& noise, const TurnedTips& turned,
                       const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TIPS_H_
