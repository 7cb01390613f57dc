#ifndef BCCSKEL_CLIENT_EXPORT_MARKUPS_H_
#define BCCSKEL_CLIENT_EXPORT_MARKUPS_H_

#include <string>

#include "client/export/graph_context.h"
#include "client/export/world.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

struct MarkupsDocument {
  std::string text;
  // What the format cannot show, as a sentence for the user; empty if nothing.
  std::string note;
};

// The note of WriteMarkups() about a world with other axes or another unit; empty for RAS and LPS
// in mm.
std::string NoteOn(const World& world);

// 3D Slicer's markups, schema 1.0.3: an open or closed curve per edge, named "branch N" or, with
// labels, "label L branch N", with its length and radii as measurements. Coordinates are RAS or
// LPS, as in `world`, in mm; any other is taken as LPS and in mm, which the note states.
MarkupsDocument WriteMarkups(const SkeletonGraph& graph, const GraphContext& context,
                             const World& world);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_MARKUPS_H_
