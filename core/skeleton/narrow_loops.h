#ifndef BCCSKEL_CORE_SKELETON_NARROW_LOOPS_H_
#define BCCSKEL_CORE_SKELETON_NARROW_LOOPS_H_

#include <cstdint>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// The number of loops around tunnels that no ball with this diameter passes, in world units; a
// lower bound.
// Does:  adds the edges in the order of their lengths. An edge closes a loop, with the shortest way
//        between its nodes, if they are connected already; so no loop is counted twice. The widest
//        ball is sought in the middle of the gap between opposite points of the loop; it must keep
//        clear of the balls along the curve, which measures the width to 15 %.
// Cost:  of the 10,000 shortest edges that close a loop, each visits up to 32 nodes in search of
//        that way and follows up to 16 edges from each. Other loops are not counted.
uint64_t CountNarrowLoops(const SkeletonGraph& graph, double width);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_NARROW_LOOPS_H_
