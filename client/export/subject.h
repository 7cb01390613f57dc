#ifndef BCCSKEL_CLIENT_EXPORT_SUBJECT_H_
#define BCCSKEL_CLIENT_EXPORT_SUBJECT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/export/graph_context.h"
#include "client/export/point_forest.h"
#include "client/export/world.h"
#include "client/view/display_surface.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/tree_order.h"
#include "core/volume/volume.h"

namespace bccskel::exporting {

struct Subject;

// Of a result that consists of the skeletons of many labels.
struct SubjectLabels {
  const GraphLabels& of_rows;
  const view::DisplaySurface& surfaces;  // of the objects of all its names, in their order
};

// Makes a PNG file of a subject.
using Drawing = absl::StatusOr<std::string> (*)(const Subject&);

// A skeleton and its object: the input of the formats. Whoever holds one keeps the two values
// alive.
struct Subject {
  const SkeletonizeResult& result;
  const Volume& object;        // not used if there are labels
  std::string title;           // of pictures; plain text
  exec::Context context = {};  // for the surfaces of pages and pictures, which take time
  // The shells of the thinning, for a page; null: shells by the distance to the boundary.
  const view::PeeledShells* shells = nullptr;
  // Where trees begin; none: they are not ordered. Needs: CheckRootChoice() is OK.
  std::optional<RootChoice> root = std::nullopt;
  World world = {};
  CurveSampling swc = {};  // of SWC files
  // Draws .png files; this library is also installed without the one that draws.
  Drawing draw = nullptr;
  std::optional<SubjectLabels> labels = std::nullopt;
};

// Errors: those of view::MakeDisplaySurface().
inline absl::StatusOr<view::DisplaySurface> SurfaceOf(const Subject& subject,
                                                      size_t most_triangles) {
  if (subject.labels.has_value()) return subject.labels->surfaces;
  return view::MakeDisplaySurface(subject.object, most_triangles, subject.context);
}

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SUBJECT_H_
