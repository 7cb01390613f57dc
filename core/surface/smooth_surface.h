#ifndef BCCSKEL_CORE_SURFACE_SMOOTH_SURFACE_H_
#define BCCSKEL_CORE_SURFACE_SMOOTH_SURFACE_H_

#include <vector>

#include "core/surface/surface_mesh.h"

namespace bccskel {

struct SurfaceSmoothing {
  int steps = 24;
  // No coordinate moves farther from where it was, lattice units. Layers of points are 1 apart, so
  // half of it lays a plane through the stairs. Less than 1 leaves something of a single point.
  float reach = 0.7f;
};

// Takes the steps of the lattice off a surface: each vertex goes to the mean of its neighbors, step
// by step, as far as its reach allows, so thin parts do not shrink away.
// Needs: a closed surface.
void SmoothSurface(SurfaceMesh& mesh, const SurfaceSmoothing& smoothing);

// Unit normals that point to the background, one per vertex.
std::vector<SurfaceVertex> NormalsOf(const SurfaceMesh& mesh);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SURFACE_SMOOTH_SURFACE_H_
