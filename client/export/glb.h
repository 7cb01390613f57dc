#ifndef BCCSKEL_CLIENT_EXPORT_GLB_H_
#define BCCSKEL_CLIENT_EXPORT_GLB_H_

#include "absl/status/statusor.h"
#include "client/export/graph_context.h"
#include "client/export/text.h"
#include "client/export/world.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// Binary glTF 2.0: a tube per edge as thick as the object, colored by radius. Nodes are named as by
// BranchName(), with the figures of the branch as extras, and are children of the node "skeleton",
// which moves them to the world: glTF's y axis, up, is the world's z, unless the world's is y as
// well. World units. The extras of "skeleton" hold the facts of the context. More than 20,000 edges
// are one mesh, of the node "branches", and a note says so. Errors: RESOURCE_EXHAUSTED for more
// than 4 GiB.
absl::StatusOr<Document> WriteGlb(const SkeletonGraph& graph, const GraphContext& context = {},
                                  const World& world = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GLB_H_
