#ifndef BCCSKEL_CORE_PRUNING_TIPS_H_
#define BCCSKEL_CORE_PRUNING_TIPS_H_

#include "absl/status/status.h"
#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Cuts every branch back, or lets it grow, to where the ridge of the distances ends. Seen along the
// limb the distance hardly changes on a ridge, falls ever faster toward a point, and by 1 per unit
// into a round cap or off into the corner of a box: so the tip is the place with the largest sum of
// the distance and 0.75 of the way along the limb. Distances are to the background without pits,
// and no tip is put on a bump (FillPits(), Denoise()): a single point says nothing of the limb.
// A tip is never cut back behind where its limb begins (LargestRun(), LastLimb), grows by the
// radius there and 6 units at most, and not into the ball of another branch. Points of `keep` are
// not cut off. Needs:  `radius` belongs to `object`; `space` is the object, or that with points
// beyond its
//         border, which no tip grows into; `noise` of its surface.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::Status PlaceTips(ThinSet& set, const Volume& object, const Volume& space,
                       const ExactRadius& radius, const PointSet& keep, const SurfaceNoise& noise,
                       const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TIPS_H_
