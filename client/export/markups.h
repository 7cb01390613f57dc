#ifndef BCCSKEL_CLIENT_EXPORT_MARKUPS_H_
#define BCCSKEL_CLIENT_EXPORT_MARKUPS_H_

#include "client/export/graph_context.h"
#include "client/export/text.h"
#include "client/export/world.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// 3D Slicer's markups, schema 1.0.3: an open or closed curve per edge, named "branch N" or, with
// labels, "label L branch N", with its length and radii as measurements. Coordinates are RAS or
// LPS, as in `world`, in mm; any other is taken as LPS and in mm, which the note
// states.
Document WriteMarkups(const SkeletonGraph& graph, const GraphContext& context, const World& world);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_MARKUPS_H_
