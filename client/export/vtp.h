#ifndef BCCSKEL_CLIENT_EXPORT_VTP_H_
#define BCCSKEL_CLIENT_EXPORT_VTP_H_

#include <string>

#include "client/export/graph_context.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// VTK XML PolyData, version 1.0, ASCII. Lines are smooth curves inside the object.
// Cells:       one vertex per node without edges, then one polyline per edge.
// Point data:  radius (world units), distance (lattice units), node_kind (0 inside an edge, else
//              1 end, 2 junction, 3 loop, 4 isolated, 5 closed surface); lattice (the lattice
//              point, in world coordinates).
// Cell data:   edge_id (-1 for vertices); length, mean_radius, min_radius, max_radius (world
//              units), tortuosity (0 for closed curves); label, where labels are given; with an
//              order of trees generation and strahler (-1 for vertices and for edges that close
//              loops), along (1 where the line runs away from its root, else 0), root_distance (of
//              the end nearer to the root, world units).
// Field data:  how it was made, a string for each of the facts.
std::string VtpText(const SkeletonGraph& graph, const GraphContext& context = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_VTP_H_
