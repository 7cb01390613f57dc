#ifndef BCCSKEL_CLIENT_EXPORT_GRAPHML_H_
#define BCCSKEL_CLIENT_EXPORT_GRAPHML_H_

#include <string>

#include "client/export/graph_labels.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// GraphML, one undirected graph with self loops and parallel edges.
// Nodes: kind, x, y, z, radius, component; loops and cavities where a closed surface has them.
// Edges: length, mean_radius, min_radius, max_radius, tortuosity (not of closed curves),
//         points ("x y z radius; x y z radius; ...").
// Both: label, where labels are given.
// World coordinates and units throughout.
std::string GraphMlText(const SkeletonGraph& graph, const GraphLabels& labels = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GRAPHML_H_
