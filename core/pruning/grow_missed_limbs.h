#ifndef BCCSKEL_CORE_PRUNING_GROW_MISSED_LIMBS_H_
#define BCCSKEL_CORE_PRUNING_GROW_MISSED_LIMBS_H_

#include "core/exec/context.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/prune.h"
#include "core/pruning/significance.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Adds limbs of thick, round bodies that thinning left out: blunt ones, such as snouts, and pointed
// ones, such as ears, in which the distance to the background falls so fast that thinning keeps a
// curve in one pose or resolution and none in another.
// Does:  finds the places of the object that lie farthest outside the balls of the curves
//        (BallGaps), climbs from each to the curve up the ridge of the depths, and keeps this path
//        if it is significant (Significance::Of()).
// Why the topology stays: each point touches the set only at the point before it.
// Needs: `depths` belong to in.object, or to in.space; `noise` is that of the surface.
void GrowMissedLimbs(ThinSet& set, const PrunedObject& in, TipDepths& depths,
                     const SurfaceNoise& noise, Significance& significance, double threshold,
                     const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_GROW_MISSED_LIMBS_H_
