#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_CROSSINGS_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_CROSSINGS_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/import/mesh/mesh_report.h"

namespace bccskel {

// The number of pairs of triangles that cross: an edge of one pierces the interior of the other.
// Triangles that only touch, overlap in a plane or share an edge do not cross.
// Cost:   follows the triangles and the pairs with overlapping boxes.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<uint64_t> CountCrossings(const Surface& surface, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_CROSSINGS_H_
