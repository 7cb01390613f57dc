#ifndef BCCSKEL_CORE_PRUNING_GROW_BODY_ENDS_H_
#define BCCSKEL_CORE_PRUNING_GROW_BODY_ENDS_H_

#include "core/exec/context.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/prune.h"
#include "core/pruning/significance.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Adds the ends of bodies that thinning left out. Where the distance to the background falls by
// more than about 0.25 per unit toward the end of a body, thinning keeps no curve. Without limbs,
// tips grow there (PlaceTips()); where thin limbs leave the body before its end, its curve turns
// into them and has no tip. What it has of the end of a trunk soon behind a twig may be too short
// to stay.
// Does:  at each junction, and where a curve turns from a body into a thinner limb, follows the
//        ridge of the depths straight on from the body. The points found stay as a branch if they
//        lie in no other branch's ball and are significant (Significance::OfBodyEnd()).
// Why the topology stays: each point touches the set only at the point before it.
// Does:  each place is tried as if it were the first, like tips by PlaceTips().
// Needs: `depths` belong to in.object, or to in.space.
void GrowBodyEnds(ThinSet& set, const PrunedObject& in, TipDepths& depths,
                  Significance& significance, double threshold, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_GROW_BODY_ENDS_H_
