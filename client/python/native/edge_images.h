#ifndef BCCSKEL_CLIENT_PYTHON_NATIVE_EDGE_IMAGES_H_
#define BCCSKEL_CLIENT_PYTHON_NATIVE_EDGE_IMAGES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "client/python/native/compute.h"
#include "core/exec/context.h"
#include "core/labels/edge_image.h"

namespace bccskel::python {

enum class EdgeImage {
  kCurves,    // DrawSkeleton()
  kBranches,  // NearestEdges()
};

// The image on the grid of the mask or the label.
// Errors: INVALID_ARGUMENT for a mesh, a sampling or a prepared object, since their voxels differ
//         from the thinned ones; UNIMPLEMENTED for a label that a server has computed; those of
//         the function.
absl::StatusOr<SparseImage> ImageOf(const Outcome& outcome, EdgeImage kind,
                                    const exec::Context& context);

// The voxel x, y, z of each node: one of the object, unless the object is unknown or is no longer
// that of the voxels, as in samplings; then the nearest one of the grid.
// Needs:  a grid.
// Errors: as NodeVoxels().
absl::StatusOr<std::vector<std::array<int32_t, 3>>> VoxelsOfNodes(const Outcome& outcome,
                                                                  const exec::Context& context);

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_EDGE_IMAGES_H_
