#ifndef BCCSKEL_CORE_LABELS_CURVE_POINTS_H_
#define BCCSKEL_CORE_LABELS_CURVE_POINTS_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/labels/run_lookup.h"
#include "core/mask/mask_grid.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// A curve point of a skeleton on the grid of an image.
struct CurvePoint {
  std::array<double, 3> at = {};      // in voxels, voxel centers at integers
  std::array<int32_t, 3> voxel = {};  // of the object
  RunIndex run = 0;                   // that holds the voxel
  uint32_t value = 0;                 // see edge_image.h
};

// The points of every edge, so a node once for each of its edges, and the nodes without edges.
// Points with no object voxel around them, as samplings may make, are left out.
// Errors: INVALID_ARGUMENT when the grid's direction has no inverse.
absl::StatusOr<std::vector<CurvePoint>> CurvePointsOf(const SkeletonGraph& graph,
                                                      const MaskGrid& grid,
                                                      const RunLookup& lookup);

// The voxel of each node: the first object voxel, as for curve points; where there is none, the
// grid's voxel next to the node.
// Errors: INVALID_ARGUMENT as above.
absl::StatusOr<std::vector<std::array<int32_t, 3>>> NodeVoxels(const SkeletonGraph& graph,
                                                               const MaskGrid& grid,
                                                               const RunLookup& lookup);

// The first object voxel, in the order of z, y, x, that both points lie in or beside: their places
// are at most half a voxel from its center along each axis, or one voxel if there is none.
std::optional<std::array<int32_t, 3>> SharedVoxel(const CurvePoint& a, const CurvePoint& b,
                                                  const RunLookup& lookup);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_CURVE_POINTS_H_
