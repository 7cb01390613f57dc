#ifndef BCCSKEL_CLIENT_EXPORT_GRAPHML_H_
#define BCCSKEL_CLIENT_EXPORT_GRAPHML_H_

#include <string>

#include "client/export/graph_context.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// GraphML, one undirected graph with self loops and parallel edges.
// Nodes: kind, x, y, z, radius, component; loops and cavities where a closed surface has them.
// Edges: length, mean_radius, min_radius, max_radius, tortuosity (not of closed curves),
//         points ("x y z radius; x y z radius; ...").
// Both: label, where labels are given; a string, since GraphML's long is too short for 64 bits
//         without a sign.
// With an order of trees: of nodes root, parent and root_distance; of edges proximal, generation
//         and strahler, or closes_loop. Roots have no parent.
// Graph: how it was made, a string for each of the facts.
// World coordinates and units throughout.
std::string GraphMlText(const SkeletonGraph& graph, const GraphContext& context = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GRAPHML_H_
