#ifndef BCCSKEL_CORE_IMPORT_SHAPES_BOUNDARY_NOISE_H_
#define BCCSKEL_CORE_IMPORT_SHAPES_BOUNDARY_NOISE_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/volume/volume.h"

namespace bccskel::shapes {

// Flips about `fraction` of the points on either side of the boundary: object points with a
// background neighbor leave, background points with an object neighbor join. Whether a point flips
// depends on the seed and its coordinates alone.
absl::StatusOr<Volume> WithBoundaryNoise(const Volume& object, double fraction, uint64_t seed);

}  // namespace bccskel::shapes

#endif  // BCCSKEL_CORE_IMPORT_SHAPES_BOUNDARY_NOISE_H_
