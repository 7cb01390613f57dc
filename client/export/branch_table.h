#ifndef BCCSKEL_CLIENT_EXPORT_BRANCH_TABLE_H_
#define BCCSKEL_CLIENT_EXPORT_BRANCH_TABLE_H_

#include <string>

#include "client/export/graph_context.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// CSV, a row per edge below a row of names; the names are those of skan where skan has them.
//   label                               where labels are given
//   skeleton_id                         connected component, from 0
//   branch_id                           edge of the graph, from 0
//   node_id_src, node_id_dst            nodes of the graph, from 0
//   branch_type                         0 end to end, 1 junction to end, 2 junction to junction,
//                                       3 closed curve without junction
//   branch_distance                     length of the smooth curve
//   euclidean_distance                  straight distance between the nodes
//   tortuosity                          their ratio; empty where the nodes are one place
//   mean_radius, min_radius, max_radius
//   coord_src_x .. coord_dst_z          places of the nodes
//   pruning_level                       empty for branches that are never pruned
//   generation, strahler                with an order of trees; empty where an edge closes a loop
//   world, unit                         those of the facts of the context, the same in each row
// World coordinates and units. Isolated nodes and closed surfaces have no row.
std::string BranchTableText(const SkeletonGraph& graph, const GraphContext& context = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_BRANCH_TABLE_H_
