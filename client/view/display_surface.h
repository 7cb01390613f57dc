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

// A surface for the eye: in the world, smoothed, and with no more triangles than it takes.
struct DisplaySurface {
  std::vector<WorldPoint> vertices;
  std::vector<SurfaceTriangle> triangles;  // counterclockwise seen from outside
};

// Simplification stays within the budget unless topology forbids it; then it comes close. If the
// surface has far more triangles than the budget, it is built from cells of several points: see
// ExtractCellSurface().
// Errors: those of ExtractSurface().
absl::StatusOr<DisplaySurface> MakeDisplaySurface(const Volume& object, size_t most_triangles,
                                                  const exec::Context& context);

// What is left of an object when its outer shells are peeled off.
struct Peeled {
  int32_t shells = 0;  // how many are gone; 0 for the object itself
  DisplaySurface surface;
};

struct PeelingLimits {
  size_t object_triangles = 100'000;
  size_t layer_triangles = 20'000;
  int32_t layers = 20;
};

struct Peeling {
  std::vector<Peeled> layers;  // first the object itself, then with more and more shells gone
  int32_t last_shell = 0;
};

// The object and a choice of its layers, evenly spread, by the distance to the background. Shells
// are one lattice unit thick.
// Errors: those of ExtractSurface().
absl::StatusOr<Peeling> PeelForDisplay(const Volume& object, const PeelingLimits& limits,
                                       const exec::Context& context);

// The points that went with each shell when the object was thinned.
using PeeledShells = std::map<int32_t, Volume>;

// The same by the shells of a thinning: a layer is what went later. `last_shell` is the object's
// deepest; what went after it is no part of a layer.
// Errors: those of ExtractSurface().
absl::StatusOr<Peeling> PeelByShells(const Volume& object, const PeeledShells& shells,
                                     int32_t last_shell, const PeelingLimits& limits,
                                     const exec::Context& context);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_DISPLAY_SURFACE_H_
