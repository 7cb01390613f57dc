#include "client/view/display_surface.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <utility>

#include "core/distance/distance_field.h"
#include "core/exec/status_macros.h"
#include "core/export/surface/cell_grid.h"
#include "core/export/surface/smooth_surface.h"
#include "core/shells/shells.h"

namespace bccskel::view {
namespace {

constexpr double kShellWidth = 1;
constexpr int kMostLayersAtOnce = 4;  // each takes memory for the cells of the object

// A surface may have this many times the requested triangles before simplification: more take long
// and are not visible.
constexpr double kExcess = 2;
// For surfaces made of cells, in cells: enough to smooth their steps.
constexpr float kCellReach = 3;

// Fewer triangles, ordered so that neighbors in space are neighbors in memory.
void Simplify(SurfaceMesh& mesh, size_t most_triangles) {
  static_assert(sizeof(SurfaceVertex) == 3 * sizeof(float));
  static_assert(sizeof(SurfaceTriangle) == 3 * sizeof(uint32_t));
  if (mesh.triangles.empty()) return;
  const uint32_t* all = mesh.triangles.front().data();
  std::vector<SurfaceTriangle> triangles(mesh.triangles.size());
  uint32_t* indices = triangles.front().data();
  const float* positions = mesh.vertices.front().data();
  const size_t most = 3 * std::min(most_triangles, mesh.triangles.size());
  constexpr float kAnyError = 1e9f;
  const size_t left =
      meshopt_simplify(indices, all, 3 * mesh.triangles.size(), positions, mesh.vertices.size(),
                       sizeof(SurfaceVertex), most, kAnyError);
  triangles.resize(left / 3);
  mesh.triangles = std::move(triangles);
  meshopt_optimizeVertexCache(indices, indices, left, mesh.vertices.size());
  mesh.vertices.resize(meshopt_optimizeVertexFetch(mesh.vertices.data(), indices, left,
                                                   mesh.vertices.data(), mesh.vertices.size(),
                                                   sizeof(SurfaceVertex)));
}

// As fine as simplification can use: of points, or of cells as wide as necessary.
absl::StatusOr<SurfaceMesh> SmoothMesh(const Volume& object, size_t most_triangles,
                                       const exec::Context& context) {
  constexpr double kTrianglesPerPoint = 11;  // of ExtractSurface(), per point of the finest cells
  const double affordable = kExcess * static_cast<double>(most_triangles);
  BCCSKEL_ASSIGN_OR_RETURN(CellGrid grid, CellGrid::Of(object, context));
  if (kTrianglesPerPoint * grid.TriangleEstimate() <= affordable) {
    BCCSKEL_ASSIGN_OR_RETURN(SurfaceMesh mesh, ExtractSurface(object, context));
    SmoothSurface(mesh, {});
    return mesh;
  }
  while (grid.TriangleEstimate() > affordable && grid.keys().size() > 1) {
    BCCSKEL_ASSIGN_OR_RETURN(grid, grid.Halved(context));
  }
  BCCSKEL_ASSIGN_OR_RETURN(SurfaceMesh mesh, ExtractCellSurface(grid, context));
  SmoothSurface(mesh,
                {.steps = 12, .reach = kCellReach * grid.edge(), .pull = 0.6f, .push = 0.62f});
  return mesh;
}

double Determinant(const std::array<double, 9>& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

DisplaySurface InWorld(const SurfaceMesh& mesh, const Placement& placement) {
  DisplaySurface surface;
  surface.vertices.reserve(mesh.vertices.size());
  for (const auto& [x, y, z] : mesh.vertices) {
    surface.vertices.push_back(placement.ToWorld(x, y, z));
  }
  surface.triangles = mesh.triangles;
  if (Determinant(placement.direction) < 0) {  // a mirror turns triangles inside out
    for (SurfaceTriangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  }
  return surface;
}

// The points of an object deeper than a shell.
Volume DeeperThan(int32_t shell, const Volume& object, const DistanceField& distance) {
  std::vector<BrickKey> keys(object.keys().begin(), object.keys().end());
  std::vector<BrickBits> bricks(object.bricks().begin(), object.bricks().end());
  for (BrickIndex n = 0; n < bricks.size(); ++n) {
    object.bricks()[n].ForEachSetBit([&](int bit) {
      if (ShellOf(distance.At(n, bit), distance.weights(), kShellWidth) <= shell) {
        bricks[n].Clear(bit);
      }
    });
  }
  return Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                  std::move(bricks));
}

// The points of the shells after this one.
Volume GoneAfter(int32_t shell, int32_t last_shell, const Volume& object,
                 const PeeledShells& shells) {
  VolumeBuilder builder(object.extent(), object.placement());
  for (const auto& [number, points] : shells) {
    if (number <= shell || number > last_shell) continue;
    for (size_t n = 0; n < points.brick_count(); ++n) {
      builder.Brick(points.keys()[n]) |= points.bricks()[n];
    }
  }
  absl::StatusOr<Volume> later = std::move(builder).Build();
  return later.ok() ? *std::move(later) : Volume();
}

// `later(shell)` is what remains when that many shells are removed.
absl::StatusOr<Peeling> PeelLayers(const Volume& object, int32_t last_shell,
                                   const std::function<Volume(int32_t)>& later,
                                   const PeelingLimits& limits, const exec::Context& context) {
  Peeling peeling = {.layers = {{0, {}}}, .last_shell = last_shell};
  const int32_t inner = std::max(0, std::min(limits.layers, last_shell - 1));
  for (int32_t n = 1; n <= inner; ++n) peeling.layers.push_back({n * (last_shell - 1) / inner, {}});
  std::vector<absl::Status> done(peeling.layers.size());
  exec::Context alone = context;  // each layer is one thread's
  alone.team = nullptr;
  exec::Context few = context;
  few.share = [&context] { return std::min(kMostLayersAtOnce, context.usable_threads()); };
  BCCSKEL_RETURN_IF_ERROR(few.ForEachShare(done.size(), 1, [&](exec::Share share) {
    auto& [shell, surface] = peeling.layers[share.begin];
    absl::StatusOr<DisplaySurface> made =
        shell == 0 ? MakeDisplaySurface(object, limits.object_triangles, alone)
                   : MakeDisplaySurface(later(shell), limits.layer_triangles, alone);
    done[share.begin] = made.status();
    if (made.ok()) surface = *std::move(made);
  }));
  for (const absl::Status& status : done) BCCSKEL_RETURN_IF_ERROR(status);
  return peeling;
}

}  // namespace

absl::StatusOr<DisplaySurface> MakeDisplaySurface(const Volume& object, size_t most_triangles,
                                                  const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(SurfaceMesh mesh, SmoothMesh(object, most_triangles, context));
  Simplify(mesh, most_triangles);
  return InWorld(mesh, object.placement());
}

absl::StatusOr<Peeling> PeelForDisplay(const Volume& object, const PeelingLimits& limits,
                                       const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const DistanceField distance,
                           ComputeDistance(object, DistanceKind::kChamfer, context));
  const int32_t last_shell = ShellOf(distance.largest(), distance.weights(), kShellWidth);
  const auto later = [&](int32_t shell) { return DeeperThan(shell, object, distance); };
  return PeelLayers(object, last_shell, later, limits, context);
}

absl::StatusOr<Peeling> PeelByShells(const Volume& object, const PeeledShells& shells,
                                     int32_t last_shell, const PeelingLimits& limits,
                                     const exec::Context& context) {
  const auto later = [&](int32_t shell) { return GoneAfter(shell, last_shell, object, shells); };
  return PeelLayers(object, last_shell, later, limits, context);
}

}  // namespace bccskel::view
