#include "core/export/surface/smooth_surface.h"

#include <algorithm>

namespace bccskel {
namespace {

void AddTo(SurfaceVertex& sum, const SurfaceVertex& v) {
  for (size_t axis = 0; axis < 3; ++axis) sum[axis] += v[axis];
}

// Every edge is walked once in each direction, so each vertex meets each of its neighbors once.
void SumNeighbors(const SurfaceMesh& mesh, std::vector<SurfaceVertex>& sums,
                  std::vector<float>& counts) {
  std::ranges::fill(sums, SurfaceVertex{});
  std::ranges::fill(counts, 0.0f);
  for (const SurfaceTriangle& triangle : mesh.triangles) {
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint32_t here = triangle[corner], next = triangle[(corner + 1) % 3];
      AddTo(sums[here], mesh.vertices[next]);
      counts[here] += 1;
    }
  }
}

// A vertex on its way from `start` to `goal`, held back the more the farther it goes; a plain limit
// would leave kinks where it is met. The way t(1 - t^2 / reach^2) is longest at reach / sqrt(3).
SurfaceVertex HeldBack(const SurfaceVertex& goal, const SurfaceVertex& start, float reach) {
  const SurfaceVertex way = Minus(goal, start);
  const float square = Dot(way, way);
  const float free = std::max(0.0f, 1 - square / (reach * reach));
  return {start[0] + free * way[0], start[1] + free * way[1], start[2] + free * way[2]};
}

}  // namespace

void SmoothSurface(SurfaceMesh& mesh, const SurfaceSmoothing& smoothing) {
  const std::vector<SurfaceVertex> start = mesh.vertices;
  std::vector<SurfaceVertex> sums(start.size());
  std::vector<float> counts(start.size());
  const auto move = [&](float part) {  // of the way to the mean of the neighbors
    SumNeighbors(mesh, sums, counts);
    for (size_t n = 0; n < start.size(); ++n) {
      const SurfaceVertex& here = mesh.vertices[n];
      SurfaceVertex goal;
      for (size_t axis = 0; axis < 3; ++axis) {
        goal[axis] = here[axis] + part * (sums[n][axis] / counts[n] - here[axis]);
      }
      mesh.vertices[n] = HeldBack(goal, start[n], smoothing.reach);
    }
  };
  for (int step = 0; step < smoothing.steps; ++step) {
    move(smoothing.pull);
    if (smoothing.push > 0) move(-smoothing.push);
  }
}

std::vector<SurfaceVertex> NormalsOf(const SurfaceMesh& mesh) {
  std::vector<SurfaceVertex> normals(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const SurfaceVertex& origin = mesh.vertices[a];
    const SurfaceVertex face =
        Cross(Minus(mesh.vertices[b], origin), Minus(mesh.vertices[c], origin));
    for (const uint32_t corner : {a, b, c}) AddTo(normals[corner], face);
  }
  for (SurfaceVertex& n : normals) {
    const float length = LengthOf(n);
    if (length > 0) n = {n[0] / length, n[1] / length, n[2] / length};
  }
  return normals;
}

}  // namespace bccskel
