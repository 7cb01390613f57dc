#ifndef BCCSKEL_CORE_SKELETON_VOXEL_RADII_H_
#define BCCSKEL_CORE_SKELETON_VOXEL_RADII_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// Does:  measures the radius of points of a skeleton in the solid that a mask samples: half the
//        chord through the point in the direction of the nearest background.
// Why:   the nearest background point is the center of a voxel just outside the solid: the nearest
//        of many for round surfaces, and half a voxel off for flat ones. A lattice point also lies
//        up to half a voxel off the middle. So half a voxel is subtracted where the surface is
//        flat, and the chord extends to the face where it leaves the object on the other side. If
//        the other side is more than a voxel and a half farther away, the point is not near the
//        middle, and only the near side counts. The result is at least half the shortest edge of a
//        voxel.
// Cost:  a search for background at a known distance (see ExactRadius) and a dozen look-ups per
//        point.
// Needs: an exact conversion of a mask, whose voxel edge is `voxel_units` lattice units (2 or 4);
//        `search`, which belongs to it, searches.
// Shapes: `exact` and the result have one value per point of `thin`, in lattice units, in the order
//         of Volume::ForEachPoint().
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::vector<float>> MeasureVoxelRadii(const Volume& object, int32_t voxel_units,
                                                     const ExactRadius& search, const Volume& thin,
                                                     std::span<const float> exact,
                                                     const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_VOXEL_RADII_H_
