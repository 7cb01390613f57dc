#ifndef BCCSKEL_CORE_LABELS_EDGE_IMAGE_H_
#define BCCSKEL_CORE_LABELS_EDGE_IMAGE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/labels/voxel_runs.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// Voxels of one value.
struct ValueRun {
  VoxelRun voxels;
  uint32_t value = 0;

  friend constexpr auto operator<=>(const ValueRun&, const ValueRun&) = default;
};

// An image is the runs of its non-zero values, in order. In the images below the value of an edge
// is its index in the graph + 1; a node that no edge touches has its index + 1 + the edges' number.
using SparseImage = std::vector<ValueRun>;

// For every voxel of the object the edge whose curve points are nearest to the voxel's center, in
// world distance along the image's axes (its direction is taken as orthogonal); on ties the
// smallest value. Only edges of the voxel's own component count. Exact.
// Needs: the graph is the object's skeleton, so it lies in the grid's world.
// Cost:   a search among the component's curve points for each voxel, with the answer of the voxel
//         before as hint. Memory follows the object.
// Errors: INVALID_ARGUMENT (a direction matrix without inverse), CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<SparseImage> NearestEdges(const MaskGrid& grid, const LabeledObject& object,
                                         const SkeletonGraph& graph, MaskAdjacency adjacency,
                                         const exec::Context& context);

// The voxels of the object that curve points fall in. A point between voxels falls in the first of
// them, in the order of z, y, x, that is in the object; beside a notch two successive points may so
// fall in voxels that do not touch, and the voxel that both lie beside is added. A voxel of several
// edges has the smallest value. The voxels of an exactly converted component are connected (26).
// Errors: INVALID_ARGUMENT as above.
absl::StatusOr<SparseImage> DrawSkeleton(const MaskGrid& grid, const LabeledObject& object,
                                         const SkeletonGraph& graph);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_EDGE_IMAGE_H_
