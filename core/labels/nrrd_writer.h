#ifndef BCCSKEL_CORE_LABELS_NRRD_WRITER_H_
#define BCCSKEL_CORE_LABELS_NRRD_WRITER_H_

#include <string>

#include "absl/status/statusor.h"
#include "core/labels/edge_image.h"
#include "core/mask/mask_grid.h"

namespace bccskel {

// What the axes of the world point to ("RAS", "LPS" or "LAS") and its unit. Empty: unknown.
struct ImageWorld {
  std::string axes;
  std::string unit;
};

// An image of the grid as NRRD: unsigned 32-bit integers, gzip, with spacing, origin, direction and
// world. Memory: one slice and the compressed image.
// Errors: INVALID_ARGUMENT (a run outside the grid or out of order).
absl::StatusOr<std::string> NrrdBytes(const MaskGrid& grid, const ImageWorld& world,
                                      const SparseImage& image);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_NRRD_WRITER_H_
