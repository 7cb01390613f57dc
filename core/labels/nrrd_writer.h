#ifndef BCCSKEL_CORE_LABELS_NRRD_WRITER_H_
#define BCCSKEL_CORE_LABELS_NRRD_WRITER_H_

#include <string>

#include "absl/status/status.h"
#include "core/labels/edge_image.h"
#include "core/mask/mask_grid.h"

namespace bccskel {

// Writes an image of the grid as NRRD: unsigned 32-bit integers, gzip, with spacing, origin and
// direction. Memory: one slice.
// Errors: INVALID_ARGUMENT (a run outside the grid or out of order), UNKNOWN (the file).
absl::Status WriteNrrd(const std::string& path, const MaskGrid& grid, const SparseImage& image);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_NRRD_WRITER_H_
