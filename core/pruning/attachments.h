#ifndef BCCSKEL_CORE_PRUNING_ATTACHMENTS_H_
#define BCCSKEL_CORE_PRUNING_ATTACHMENTS_H_

#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/pruning/prune.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Moves branches that begin beside another curve: a branch may run a long way inside the largest
// balls of that curve before their common junction, as dendrites do in a long soma. Afterwards it
// meets the curve where it enters those balls.
// Does:  per branch from a junction J, finds its last point q up to which it lies within 0.9 of the
//        balls of other curves whose way from J is longer than two radii, and the point t of that
//        curve whose ball holds q deepest; the new way runs from q to a place on the curve as far
//        before t as q is away from it. The object's points between the old way and the curve are
//        added one by one, each simple at its turn; then they go, with the old way, the farthest
//        from the new way first, each simple at its turn. So the topology stays. Where the new way
//        is not as short as it should be, since other branches lie between, all stays as it was.
// Needs: `radius` belongs to `object`. New points get the level of q.
// Cost:  a few table lookups per point near junctions; the area between the curves where they move.
void SlideAttachments(ThinSet& set, const Volume& object, const ExactRadius& radius,
                      const PointSet& keep, const exec::Context& context, PruningLevels& levels);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_ATTACHMENTS_H_
