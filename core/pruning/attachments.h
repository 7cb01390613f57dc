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
// Does:  looks, per branch from a junction J, for a point q of it and a point t of another curve so
//        that q lies within 0.9 of the ball of t, |q - J| + |t - J| > 2 D(t), and |q - J| - |q -
//        t|, the gain, is as large as possible, at least 0.3 D(t), 0.4 |q - J| and 5 units. Between
//        J and t no ball is smaller than 0.6 D(J): the curve runs on in the same body. The new way
//        runs from q to a place on the curve a little before t. The object's points between the old
//        way and the curve are added one by one, each simple at its turn; then they go, with the
//        old way, the farthest from the new way first, each simple at its turn. So the topology
//        stays. Where the new way is not as short as it should be, since something lies between,
//        all stays.
// Needs: `radius` belongs to `object`. New points get the level of q.
// Cost:  the pairs of points near junctions; the area between the curves where they move.
void SlideAttachments(ThinSet& set, const Volume& object, const ExactRadius& radius,
                      const PointSet& keep, const exec::Context& context, PruningLevels& levels);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_ATTACHMENTS_H_
