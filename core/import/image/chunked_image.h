#ifndef BCCSKEL_CORE_IMPORT_IMAGE_CHUNKED_IMAGE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_CHUNKED_IMAGE_H_

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/image_info.h"
#include "core/import/image/image_limits.h"
#include "core/import/image/image_source.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel {

// Which chunk of an image, or how many voxels of one: x, y, z.
using ChunkIndex = std::array<int64_t, 3>;

// The voxels of one chunk, as far as they lie in the image: voxel (x, y, z) of the chunk begins at
// first + x * step[0] + y * step[1] + z * step[2]. Steps are in bytes.
struct ChunkVoxels {
  const std::byte* first;
  std::array<size_t, 3> step;
};

// Where the chunks of an image are.
class ChunkStore {
 public:
  virtual ~ChunkStore() = default;
  // Nothing where the chunk is missing: then all its voxels have the fill value. What is returned
  // lives until the next call.
  // Errors: INVALID_ARGUMENT for damaged chunks; errors of the system. Messages name the chunk.
  virtual absl::StatusOr<std::optional<ChunkVoxels>> Read(const ChunkIndex& chunk) = 0;
};

// An image that is cut into chunks of one size, but for those at its end.
struct ChunkedImage {
  ImageInfo info;  // info.type follows from the next two
  VoxelType stored_type = VoxelType::kUint8;
  StoredHalves halves = StoredHalves::kNo;
  std::endian byte_order = std::endian::little;
  ChunkIndex chunk_size = {1, 1, 1};   // voxels
  std::array<std::byte, 8> fill = {};  // the bytes of one voxel, in byte_order
};

// Reads a slab of chunks at a time and gives its slices. A slab above
// ImageLimits::max_chunk_slab_bytes is read in several steps.
// Needs:  info.size from SizeOfAxes(), info.placement from PlacementOf...(), positive chunk_size.
// Errors: RESOURCE_EXHAUSTED for more chunks than ImageLimits::max_chunks.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenChunkedImage(ChunkedImage image,
                                                              std::unique_ptr<ChunkStore> store,
                                                              const ImageLimits& limits);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_CHUNKED_IMAGE_H_
