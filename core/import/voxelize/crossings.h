#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_CROSSINGS_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_CROSSINGS_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/import/mesh/mesh_report.h"

namespace bccskel {

// Pairs of triangles that cross.
struct CrossingCount {
  uint64_t within_parts = 0;   // of one component, which crosses itself
  uint64_t between_parts = 0;  // of two components

  uint64_t total() const { return within_parts + between_parts; }
};

// Counts the pairs of triangles that cross: each has corners on both sides of the other's plane,
// and they have more than a point in common. Triangles that only touch, overlap in a plane or share
// an edge do not cross, up to rounding: parts that touch in a turned pose may.
// Cost:   follows the triangles and the pairs with overlapping boxes.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<CrossingCount> CountCrossings(const Surface& surface, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_CROSSINGS_H_
