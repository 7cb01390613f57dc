#ifndef BCCSKEL_CLIENT_EXPORT_OBJ_H_
#define BCCSKEL_CLIENT_EXPORT_OBJ_H_

#include <stop_token>
#include <string>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// Wavefront OBJ: one `l` element per edge, its smooth curve, one `p` element per isolated node.
// World coordinates; OBJ cannot hold radii.
std::string ObjText(const SkeletonGraph& graph, const std::stop_token& stop = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_OBJ_H_
