#ifndef BCCSKEL_CORE_EXPORT_SURFACE_SMOOTH_SURFACE_H_
#define BCCSKEL_CORE_EXPORT_SURFACE_SMOOTH_SURFACE_H_

#include <vector>

#include "core/export/surface/surface_mesh.h"

namespace bccskel {

struct SurfaceSmoothing {
  int steps = 60;
  // Lattice units. No vertex moves farther than 0.385 of it, about a layer and a half of points;
  // more is smoother, but shrinks thin parts.
  float reach = 4;
  float pull = 1;  // fraction of the way to the mean that a step moves
  // And how much of it is taken back after each step: a surface of few vertices, each far from its
  // neighbors, would shrink (Taubin 1995, doi 10.1145/218380.218473).
  float push = 0;
};

// Smooths the steps of the lattice: each vertex moves to the mean of its neighbors, step
// by step, and the farther it gets the more it is held back, so thin parts do not shrink away.
// Needs: a closed surface.
void SmoothSurface(SurfaceMesh& mesh, const SurfaceSmoothing& smoothing);

// Unit normals that point to the background, one per vertex.
std::vector<SurfaceVertex> NormalsOf(const SurfaceMesh& mesh);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXPORT_SURFACE_SMOOTH_SURFACE_H_
