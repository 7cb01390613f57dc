#ifndef BCCSKEL_TESTS_CORE_IMPORT_VOXELIZE_WINDING_REFERENCE_H_
#define BCCSKEL_TESTS_CORE_IMPORT_VOXELIZE_WINDING_REFERENCE_H_

#include <array>
#include <cstdint>
#include <functional>

#include "core/import/mesh/triangle_mesh.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

// Oracles of the voxelizer: slow, in floating point, and along another line than its exact rays.

namespace bccskel::test {

// Crossings of the ray from `p` in a skew direction that meets no edge of any ordinary mesh.
struct SkewRay {
  int winding = 0;  // +1 where it leaves a solid with outward normals, -1 where it enters
  int crossings = 0;
};
SkewRay CastSkewRay(const TriangleMesh& mesh, const WorldPoint& p);

// Generalized winding number of any triangles: the sum of their solid angles over 4 pi.
double SolidAngleWinding(const TriangleMesh& mesh, const WorldPoint& p);

double DistanceToSurface(const TriangleMesh& mesh, const WorldPoint& p);

// How a volume compares with a solid that is given by a claim about world points.
struct Agreement {
  uint64_t points = 0;     // lattice points looked at: all of the extent
  uint64_t inside = 0;     // of them inside by the claim
  uint64_t different = 0;  // classified otherwise by the volume, and not excused
};
// A point that differs is excused when it is nearer to the surface than the rounding of vertices:
// 2^-15 lattice units.
Agreement Compare(const Volume& volume, const TriangleMesh& mesh,
                  const std::function<bool(const WorldPoint&)>& is_inside);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_IMPORT_VOXELIZE_WINDING_REFERENCE_H_
