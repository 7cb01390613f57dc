#ifndef BCCSKEL_CLIENT_VIEW_DISPLAY_SURFACE_H_
#define BCCSKEL_CLIENT_VIEW_DISPLAY_SURFACE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/export/surface/surface_mesh.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel::view {

// A surface for display: in world coordinates, smoothed, and simplified.
struct DisplaySurface {
  std::vector<WorldPoint> vertices;
  std::vector<SurfaceTriangle> triangles;  // counterclockwise seen from outside
  // Of the objects of many labels, one after the other; empty for one object.
  std::vector<size_t> triangles_of_labels = {};
};

// Simplification stays within the budget unless topology forbids it; then it comes close. If the
// surface has far more triangles than the budget, it is built from cells of several points: see
// ExtractCellSurface().
// Errors: those of ExtractSurface().
absl::StatusOr<DisplaySurface> MakeDisplaySurface(const Volume& object, size_t most_triangles,
                                                  const exec::Context& context);

// The rest of an object after its outer shells are peeled off.
struct Peeled {
  int32_t shells = 0;  // number of shells removed; 0 for the object itself
  DisplaySurface surface;
};

struct PeelingLimits {
  size_t object_triangles = 100'000;
  size_t layer_triangles = 20'000;
  int32_t layers = 20;
};

struct Peeling {
  std::vector<Peeled> layers;  // the object itself, then with more and more shells removed
  int32_t last_shell = 0;
};

// The object and evenly spread layers of it, by the distance to the background. Shells are one
// lattice unit thick.
// Errors: those of ExtractSurface().
absl::StatusOr<Peeling> PeelForDisplay(const Volume& object, const PeelingLimits& limits,
                                       const exec::Context& context);

// The points that thinning removed with each shell.
using PeeledShells = std::map<int32_t, Volume>;

// The same by the shells of a thinning: a layer consists of what was removed later. `last_shell` is
// the object's deepest; later points belong to no layer.
// Errors: those of ExtractSurface().
absl::StatusOr<Peeling> PeelByShells(const Volume& object, const PeeledShells& shells,
                                     int32_t last_shell, const PeelingLimits& limits,
                                     const exec::Context& context);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_DISPLAY_SURFACE_H_
