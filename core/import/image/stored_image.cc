#include "core/import/image/stored_image.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/exec/uninitialized.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel {
namespace {

constexpr size_t kReadAtOnce = size_t{1} << 20;  // bytes of columns, if a column is shorter

absl::Status CheckLength(const StoredImage& image) {
  const uint64_t declared = image.VoxelBytesDeclared();
  const uint64_t rest = image.file->size() - std::min(image.stream_offset, image.file->size());
  const bool deflated = image.compression != Compression::kNone;
  const uint64_t most = deflated ? rest * kMaxDeflateRatio : rest;
  if (image.skip <= most && declared <= most - image.skip) return absl::OkStatus();
  const uint64_t begin = image.stream_offset + image.skip;
  const std::string expanded =
      deflated ? absl::StrFormat(", which expand to at most %d", most) : std::string();
  return absl::InvalidArgumentError(
      absl::StrFormat("the header declares %d bytes of voxels from byte %d on; the file has %d "
                      "bytes for them%s",
                      declared, begin, rest, expanded));
}

// The stream of an image's voxels, at its first one.
absl::StatusOr<std::unique_ptr<ByteStream>> OpenVoxels(const StoredImage& image) {
  BCCSKEL_ASSIGN_OR_RETURN(auto stream,
                           ByteStream::Open(image.file, image.stream_offset, image.compression));
  BCCSKEL_RETURN_IF_ERROR(stream->Skip(image.skip));
  return stream;
}

// Why are more bytes an error only here? A header that declares less than was compressed is either
// wrong or a bomb; behind voxels that are not compressed other things may follow.
absl::Status CheckEnd(const StoredImage& image, ByteStream& stream) {
  if (image.compression == Compression::kNone) return absl::OkStatus();
  std::array<std::byte, 1> more;
  BCCSKEL_ASSIGN_OR_RETURN(const size_t got, stream.Read(more));
  if (got == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("the header declares %d bytes of voxels, the compressed stream holds more",
                      image.VoxelBytesDeclared()));
}

absl::Status ReadWhole(ByteStream& stream, std::span<std::byte> into, int32_t slice) {
  BCCSKEL_ASSIGN_OR_RETURN(const size_t got, stream.Read(into));
  if (got == into.size()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "the voxels end %d bytes before slice %d is complete", into.size() - got, slice));
}

// What both orders share.
class StoredSource : public ImageSource {
 public:
  StoredSource(StoredImage image, std::unique_ptr<ByteStream> stream)
      : ImageSource(image.info), image_(std::move(image)), stream_(std::move(stream)) {}

 protected:
  // Writes the bytes of slice z, which comes after z - 1.
  virtual absl::Status Fill(int32_t z, std::span<std::byte> slice) = 0;

  StoredImage image_;
  std::unique_ptr<ByteStream> stream_;

 private:
  absl::StatusOr<SliceValues> ReadSlice(int32_t z) final {
    buffer_.Resize(image_.stored_type, info_.size.SliceVoxels());
    BCCSKEL_RETURN_IF_ERROR(Fill(z, buffer_.bytes()));
    if (z + 1 == info_.size.nz) BCCSKEL_RETURN_IF_ERROR(CheckEnd(image_, *stream_));
    buffer_.SwapFrom(image_.byte_order);
    if (image_.halves == StoredHalves::kYes) return buffer_.Halves();
    return image_.Scaled() ? buffer_.Scaled(image_.slope, image_.intercept) : buffer_.values();
  }

  SliceBuffer buffer_;
};

class XFastestSource : public StoredSource {
 public:
  using StoredSource::StoredSource;

 private:
  absl::Status Fill(int32_t z, std::span<std::byte> slice) override {
    return ReadWhole(*stream_, slice, z);
  }
};

// A slice lies scattered over the whole file. So the file is read once for every slab of slices
// that fits the limit, and at least one.
class ZFastestSource : public StoredSource {
 public:
  ZFastestSource(StoredImage image, std::unique_ptr<ByteStream> stream, uint64_t max_slab_bytes)
      : StoredSource(std::move(image), std::move(stream)), max_slab_bytes_(max_slab_bytes) {}

 private:
  absl::Status Fill(int32_t z, std::span<std::byte> slice) override {
    if (z >= first_ + count_) BCCSKEL_RETURN_IF_ERROR(GatherSlab(z));
    const auto begin = static_cast<size_t>(z - first_) * slice.size();
    std::memcpy(slice.data(), slab_.data() + begin, slice.size());
    return absl::OkStatus();
  }

  absl::Status GatherSlab(int32_t z) {
    const ImageSize& size = info_.size;
    const uint64_t slice_bytes = size.SliceVoxels() * VoxelBytes(image_.stored_type);
    const uint64_t fitting = std::max<uint64_t>(1, max_slab_bytes_ / slice_bytes);
    if (z > 0) {
      BCCSKEL_ASSIGN_OR_RETURN(stream_, OpenVoxels(image_));
    }
    first_ = z;
    count_ = static_cast<int32_t>(std::min<uint64_t>(fitting, static_cast<uint64_t>(size.nz - z)));
    slab_.resize(static_cast<size_t>(static_cast<uint64_t>(count_) * slice_bytes));
    const size_t column = static_cast<size_t>(size.nz) * VoxelBytes(image_.stored_type);
    const size_t at_once = std::max<size_t>(1, kReadAtOnce / column);
    const auto nx = static_cast<size_t>(size.nx), ny = static_cast<size_t>(size.ny);
    for (size_t first = 0; first < nx * ny; first += at_once) {
      columns_.resize(std::min(at_once, nx * ny - first) * column);
      BCCSKEL_RETURN_IF_ERROR(ReadWhole(*stream_, columns_, z));
      for (size_t n = 0; n * column < columns_.size(); ++n) {
        const size_t x = (first + n) / ny, y = (first + n) % ny;  // x is slowest
        ScatterColumn(columns_.data() + n * column, y * nx + x);
      }
    }
    return absl::OkStatus();
  }

  void ScatterColumn(const std::byte* column, size_t at) {
    const size_t bytes = VoxelBytes(image_.stored_type);
    const size_t slice_bytes = info_.size.SliceVoxels() * bytes;
    const std::byte* from = column + static_cast<size_t>(first_) * bytes;
    std::byte* to = slab_.data() + at * bytes;
    for (int32_t n = 0; n < count_; ++n, from += bytes, to += slice_bytes) {
      std::memcpy(to, from, bytes);
    }
  }

  uint64_t max_slab_bytes_;
  int32_t first_ = 0;
  int32_t count_ = 0;
  exec::UninitializedVector<std::byte> slab_;
  exec::UninitializedVector<std::byte> columns_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<ImageSource>> OpenStoredImage(StoredImage image,
                                                             const ImageLimits& limits) {
  image.info.type = image.halves == StoredHalves::kYes ? VoxelType::kFloat32
                    : image.Scaled()                   ? VoxelType::kFloat64
                                                       : image.stored_type;
  BCCSKEL_RETURN_IF_ERROR(CheckLength(image));
  BCCSKEL_ASSIGN_OR_RETURN(auto stream, OpenVoxels(image));
  if (image.voxel_order == VoxelOrder::kZFastest) {
    return std::make_unique<ZFastestSource>(std::move(image), std::move(stream),
                                            limits.max_slab_bytes);
  }
  return std::make_unique<XFastestSource>(std::move(image), std::move(stream));
}

}  // namespace bccskel
