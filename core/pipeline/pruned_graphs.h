#ifndef BCCSKEL_CORE_PIPELINE_PRUNED_GRAPHS_H_
#define BCCSKEL_CORE_PIPELINE_PRUNED_GRAPHS_H_

#include <cstdint>
#include <functional>

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// Receives a level and the graph that pruning with a threshold just above it leaves.
using OnPrunedGraph = std::function<void(double, const SkeletonGraph&)>;

// Does:  prunes the graph of a result further, level by level of its edges, and calls `visit` for
//        each level in ascending order. Branches are removed as by Prune(), then the points are
//        traced and junctions merged as for any result, so nodes and edges are those of another run
//        with that threshold. Tips do not move. Where another run moves a tip, the widths of limbs
//        may differ slightly between the two, so a junction at the edge of its reach may be merged
//        in only one of them. If tracing every level would take more than `most_points` points in
//        total, levels below the 10 largest are visited in equal steps.
// Shapes: the graph of a result, as returned by MergeJunctions() with `junction_reach`. Visited
//         graphs have the same placement, and the births and shifts of their points.
// Errors: those of the context and of Volume::Create().
absl::Status ForEachPrunedGraph(const SkeletonGraph& graph, double junction_reach,
                                uint64_t most_points, const exec::Context& context,
                                const OnPrunedGraph& visit);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_PRUNED_GRAPHS_H_
