#ifndef BCCSKEL_CORE_PRUNING_TIPS_H_
#define BCCSKEL_CORE_PRUNING_TIPS_H_

#include <functional>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/prune.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/turned_tips.h"

namespace bccskel {

// Cuts every branch back, or extends it, to the end of its limb: the place with the largest sum of
// the distance to the background and 0.75 of the distance along the limb, minus the distance from
// the limb's straight continuation (README.md of this folder); for flat limbs, see flat_end.h.
// Distances to the background are measured without pits, and no tip lies on a bump. A tip is never
// cut back beyond the place where its limb begins (LargestRun(), LastLimb) or turns. It grows by at
// most 6 units plus twice the radius there (once the radius where steps along one axis are at least
// twice as long as along another), and not into the ball of another branch. Points of `keep` are
// not cut off. Ends that turn aside are removed first from limbs that are not flat (TurnedTips).
// Needs:  `depths` belong to in.object, or to in.space, into which no tip grows; `noise` is that of
//         the object's surface.
// Does:   each tip is placed as if it were the first, by whichever worker is free; tips that would
//         change the same points, such as those of two limbs that touch, are placed one after the
//         other, and so are the ends of a path of which one was led to the border. So the result
//         does not depend on the number of threads.
// `meanwhile`: work that one of the workers does at the same time. It must not change the set.
// Returns the points of curves that were led to the middles of such cuts.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<PointsByAxis> PlaceTips(ThinSet& set, const PrunedObject& in, TipDepths& depths,
                                       const PointSet& keep, const SurfaceNoise& noise,
                                       const TurnedTips& turned, const exec::Context& context,
                                       const std::function<void()>& meanwhile);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TIPS_H_
