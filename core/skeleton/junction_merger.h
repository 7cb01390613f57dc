#ifndef BCCSKEL_CORE_SKELETON_JUNCTION_MERGER_H_
#define BCCSKEL_CORE_SKELETON_JUNCTION_MERGER_H_

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// The reach of a junction, in radii of its ball or of thinner limbs. Limbs with background between
// them are at least two radii apart.
inline constexpr double kDefaultJunctionReach = 1.25;
inline constexpr double kMaxJunctionReach = 4;

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckJunctionReach(double reach);

// Does:  merges junctions that lie in one ball into one node. Starting with the deepest, each
//        junction absorbs those connected by edges whose points all lie within `reach` of its
//        radii, and within `reach` of the radius of each limb that leaves it there (or within half
//        its radius, regardless of the limbs), the nearest along the paths first: those edges
//        become part of the node. Both reaches are extended by one lattice unit, because sampling
//        moves junctions by that much. An absorbed junction absorbs no others, so a row of
//        junctions along a limb stays a row. All other edges of absorbed junctions are extended to
//        the node along the path inside it. Where two straight limbs cross at a small angle, there
//        is a junction on either side, up to three times `reach` apart: these two become one node
//        in the middle of their edge. A ball with more than 17 junctions is not merged: it is a
//        sponge, and all its edges would lead to the middle.
// Why it is right: only edges of a tree disappear, each with a node, so edges - nodes stays the
//   same, and so do loops and components. A second edge between two merged junctions becomes an
//   edge from the node to itself.
// Needs: a graph in canonical order, which the result has, too; shifts are not set yet.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::Status MergeJunctions(double reach, const exec::Context& context, SkeletonGraph& graph);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_JUNCTION_MERGER_H_
