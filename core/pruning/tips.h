#ifndef BCCSKEL_CORE_PRUNING_TIPS_H_
#define BCCSKEL_CORE_PRUNING_TIPS_H_

#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Cuts every branch back, or lets it grow, to where the ridge of the distances ends. Along a ridge
// the distance hardly changes, into a round cap it falls by 1 per unit and into the corner of a box
// by 0.58: so the tip is the place with the largest sum of the distance and 0.4 of the way from an
// anchor further back.
// Points of `keep` are not cut off.
// Errors: none; stops early when the context says so.
void PlaceTips(ThinSet& set, ExactRadius& radius, const Volume& object, const PointSet& keep,
               const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TIPS_H_
