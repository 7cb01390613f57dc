#ifndef BCCSKEL_CLIENT_EXPORT_MARKUPS_H_
#define BCCSKEL_CLIENT_EXPORT_MARKUPS_H_

#include <string>

#include "client/export/graph_context.h"
#include "client/export/world.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

struct MarkupsDocument {
  std::string text;
  // What the format cannot show, a sentence for the user; empty if nothing.
  std::string note;
};

// What WriteMarkups() says of a world that it does not know; empty for one that it does.
std::string NoteOn(const World& world);

// 3D Slicer's markups, schema 1.0.3: an open or closed curve per edge, named "branch N" or, where
// labels are given, "label L branch N"; its length and radii are measurements. Coordinates are
// RAS or LPS, as the world is; one that is neither is taken for LPS, which the note says.
MarkupsDocument WriteMarkups(const SkeletonGraph& graph, const GraphContext& context,
                             const World& world);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_MARKUPS_H_
