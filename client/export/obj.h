#ifndef BCCSKEL_CLIENT_EXPORT_OBJ_H_
#define BCCSKEL_CLIENT_EXPORT_OBJ_H_

#include <string>

#include "client/export/graph_context.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// Wavefront OBJ: one `l` element per edge, its smooth curve, one `p` element per isolated node.
// World coordinates; OBJ cannot hold radii. Comments hold the facts of the context.
std::string ObjText(const SkeletonGraph& graph, const GraphContext& context = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_OBJ_H_
