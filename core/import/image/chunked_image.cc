#include "core/import/image/chunked_image.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/exec/uninitialized.h"

namespace bccskel {
namespace {

ChunkIndex AxesOf(const ImageSize& size) { return {size.nx, size.ny, size.nz}; }

int64_t ChunksAlong(int64_t voxels, int64_t chunk) { return (voxels + chunk - 1) / chunk; }

// A fixed length lets the compiler copy by one instruction.
template <size_t kBytes>
void CopyVoxels(const std::byte* from, size_t step, std::byte* to, size_t count) {
  for (size_t n = 0; n < count; ++n, from += step, to += kBytes) std::memcpy(to, from, kBytes);
}

void CopyRow(const std::byte* from, size_t step, std::byte* to, size_t count, size_t bytes) {
  if (step == bytes) {
    std::memcpy(to, from, count * bytes);
    return;
  }
  if (bytes == 1) return CopyVoxels<1>(from, step, to, count);
  if (bytes == 2) return CopyVoxels<2>(from, step, to, count);
  if (bytes == 4) return CopyVoxels<4>(from, step, to, count);
  CopyVoxels<8>(from, step, to, count);
}

class ChunkedSource : public ImageSource {
 public:
  ChunkedSource(ChunkedImage image, std::unique_ptr<ChunkStore> store, uint64_t max_slab_bytes)
      : ImageSource(image.info),
        image_(std::move(image)),
        store_(std::move(store)),
        bytes_(VoxelBytes(image_.stored_type)),
        most_slices_(static_cast<int64_t>(
            std::max<uint64_t>(1, max_slab_bytes / (image_.info.size.SliceVoxels() * bytes_)))) {}

 private:
  absl::StatusOr<SliceValues> ReadSlice(int32_t z) override {
    if (z >= end_) BCCSKEL_RETURN_IF_ERROR(ReadSlab(z));
    slice_.Resize(image_.stored_type, info_.size.SliceVoxels());
    std::memcpy(slice_.bytes().data(), SlabAt(0, 0, z), slice_.bytes().size());
    slice_.SwapFrom(image_.byte_order);
    return image_.halves == StoredHalves::kYes ? slice_.Halves() : slice_.values();
  }

  std::byte* SlabAt(int64_t x, int64_t y, int64_t z) {
    const ImageSize& size = info_.size;
    return slab_.data() + static_cast<size_t>(((z - begin_) * size.ny + y) * size.nx + x) * bytes_;
  }

  // The slices of one row of chunks from z on, as many as fit.
  absl::Status ReadSlab(int32_t z) {
    const ImageSize& size = info_.size;
    const int64_t layer = z / image_.chunk_size[2];
    begin_ = z;
    end_ = std::min({(layer + 1) * image_.chunk_size[2], int64_t{size.nz}, begin_ + most_slices_});
    slab_.resize(static_cast<size_t>(end_ - begin_) * size.SliceVoxels() * bytes_);
    for (int64_t y = 0; y < ChunksAlong(size.ny, image_.chunk_size[1]); ++y) {
      for (int64_t x = 0; x < ChunksAlong(size.nx, image_.chunk_size[0]); ++x) {
        BCCSKEL_RETURN_IF_ERROR(ReadChunk({x, y, layer}));
      }
    }
    return absl::OkStatus();
  }

  absl::Status ReadChunk(const ChunkIndex& chunk) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::optional<ChunkVoxels> there, store_->Read(chunk));
    // A missing chunk is one that repeats a single voxel.
    const ChunkVoxels voxels =
        there.has_value() ? *there : ChunkVoxels{.first = image_.fill.data(), .step = {0, 0, 0}};
    const ChunkIndex axes = AxesOf(info_.size);
    const int64_t x0 = chunk[0] * image_.chunk_size[0], y0 = chunk[1] * image_.chunk_size[1],
                  z0 = chunk[2] * image_.chunk_size[2];
    const auto width = static_cast<size_t>(std::min(image_.chunk_size[0], axes[0] - x0));
    const int64_t y_end = std::min(y0 + image_.chunk_size[1], axes[1]);
    for (int64_t z = begin_; z < end_; ++z) {
      for (int64_t y = y0; y < y_end; ++y) {
        const std::byte* from = voxels.first + static_cast<size_t>(y - y0) * voxels.step[1] +
                                static_cast<size_t>(z - z0) * voxels.step[2];
        CopyRow(from, voxels.step[0], SlabAt(x0, y, z), width, bytes_);
      }
    }
    return absl::OkStatus();
  }

  ChunkedImage image_;
  std::unique_ptr<ChunkStore> store_;
  size_t bytes_;  // of a voxel
  int64_t most_slices_;
  exec::UninitializedVector<std::byte> slab_;  // the slices from begin_ to end_
  int64_t begin_ = 0;
  int64_t end_ = 0;
  SliceBuffer slice_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<ImageSource>> OpenChunkedImage(ChunkedImage image,
                                                              std::unique_ptr<ChunkStore> store,
                                                              const ImageLimits& limits) {
  image.info.type = image.halves == StoredHalves::kYes ? VoxelType::kFloat32 : image.stored_type;
  const ChunkIndex axes = AxesOf(image.info.size);
  uint64_t chunks = 1;  // at most max_voxels
  for (size_t n = 0; n < 3; ++n) {
    chunks *= static_cast<uint64_t>(ChunksAlong(axes[n], image.chunk_size[n]));
  }
  if (chunks > limits.max_chunks) {
    return absl::ResourceExhaustedError(absl::StrFormat(
        "chunks of %d x %d x %d cut the image into %d, the limit is %d", image.chunk_size[0],
        image.chunk_size[1], image.chunk_size[2], chunks, limits.max_chunks));
  }
  return std::make_unique<ChunkedSource>(std::move(image), std::move(store),
                                         limits.max_chunk_slab_bytes);
}

}  // namespace bccskel
