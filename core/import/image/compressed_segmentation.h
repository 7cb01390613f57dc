#ifndef BCCSKEL_CORE_IMPORT_IMAGE_COMPRESSED_SEGMENTATION_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_COMPRESSED_SEGMENTATION_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "absl/status/status.h"

namespace bccskel {

// Expands one chunk of Neuroglancer's compressed segmentation with one channel.
// `size` and `block`: voxels along x, y and z, positive. `into`: x fastest, little endian, `bytes`
// (4 or 8) for each voxel.
// Errors: INVALID_ARGUMENT where the bytes point outside themselves or are of no such kind.
absl::Status ExpandCompressedSegmentation(std::span<const std::byte> packed,
                                          const std::array<int64_t, 3>& size,
                                          const std::array<int64_t, 3>& block, size_t bytes,
                                          std::span<std::byte> into);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_COMPRESSED_SEGMENTATION_H_
