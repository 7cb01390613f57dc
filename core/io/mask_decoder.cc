#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/encoded_body.h"
#include "core/io/little_endian.h"
#include "core/io/volume_decoders.h"
#include "core/mask/mask_converter.h"

namespace bccskel {
namespace {

// Words are loaded from any bit of the packed slice on.
constexpr size_t kLoadMargin = 2 * sizeof(uint64_t);

// The 64 bits that begin at bit `bit`.
uint64_t LoadBits(std::span<const std::byte> bytes, size_t bit) {
  const auto low = LoadNumber<uint64_t>(bytes, bit / 8);
  if (bit % 8 == 0) return low;
  const auto high = static_cast<uint64_t>(bytes[bit / 8 + 8]);
  return low >> (bit % 8) | high << (64 - bit % 8);
}

class MaskDecoder final : public VolumeDecoder {
 public:
  MaskDecoder(const VolumeHeader& header, MaskConverter converter)
      : header_(header),
        grid_(header.mask->grid),
        body_(header.compression),
        converter_(std::move(converter)),
        packed_((grid_.VoxelsPerSlice() + 7) / 8 + 1 + kLoadMargin),
        words_(grid_.WordsPerSlice()) {}

  absl::Status Append(std::span<const std::byte> bytes) override {
    return body_.Append(bytes, [this](auto decoded) { return AddVoxels(decoded); });
  }

  absl::StatusOr<Volume> Finish(const exec::Context& context) override {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    BCCSKEL_RETURN_IF_ERROR(body_.Finish());
    if (received_bytes_ != header_.decoded_bytes) {
      return absl::InvalidArgumentError(
          absl::StrFormat("a mask of %d x %d x %d voxels has %d bytes: only %d were sent", grid_.nx,
                          grid_.ny, grid_.nz, header_.decoded_bytes, received_bytes_));
    }
    BCCSKEL_RETURN_IF_ERROR(CheckUnusedBits());
    BCCSKEL_ASSIGN_OR_RETURN(ConvertedMask converted, std::move(converter_).Finish());
    topology_ = converted.mask;
    return std::move(converted.volume);
  }

  std::optional<BettiNumbers> mask_topology() const override { return topology_; }

 private:
  absl::Status AddVoxels(std::span<const std::byte> bytes) {
    if (bytes.size() > header_.decoded_bytes - received_bytes_) {
      return absl::InvalidArgumentError(
          absl::StrFormat("a mask of %d x %d x %d voxels has %d bytes: more were sent", grid_.nx,
                          grid_.ny, grid_.nz, header_.decoded_bytes));
    }
    received_bytes_ += bytes.size();
    while (!bytes.empty()) {
      const size_t count = std::min(bytes.size(), SliceBytes() - filled_bytes_);
      std::memcpy(packed_.data() + filled_bytes_, bytes.data(), count);
      bytes = bytes.subspan(count);
      filled_bytes_ += count;
      // A slice may begin and end within one byte.
      while (next_z_ < grid_.nz && filled_bytes_ == SliceBytes()) {
        BCCSKEL_RETURN_IF_ERROR(FlushSlice());
      }
    }
    return absl::OkStatus();
  }

  absl::Status FlushSlice() {
    const auto nx = static_cast<size_t>(grid_.nx), ny = static_cast<size_t>(grid_.ny);
    size_t word = 0;
    for (size_t y = 0; y < ny; ++y) {
      for (size_t x = 0; x < nx; x += 64, ++word) {
        words_[word] = LoadBits(packed_, first_bit_ + y * nx + x);
        if (nx - x < 64) words_[word] &= (uint64_t{1} << (nx - x)) - 1;
      }
    }
    BCCSKEL_RETURN_IF_ERROR(converter_.AddSlice(words_, exec::Context()));
    ++next_z_;
    const size_t end_bit = first_bit_ + nx * ny;
    first_bit_ = end_bit % 8;
    filled_bytes_ = first_bit_ == 0 ? 0 : 1;
    packed_[0] = packed_[end_bit / 8];
    return absl::OkStatus();
  }

  absl::Status CheckUnusedBits() const {
    if (first_bit_ == 0 || static_cast<unsigned>(packed_[0]) >> first_bit_ == 0) {
      return absl::OkStatus();
    }
    return absl::InvalidArgumentError(absl::StrFormat(
        "the last byte of a mask of %d x %d x %d voxels has bits past the last voxel: must be 0",
        grid_.nx, grid_.ny, grid_.nz));
  }

  // Bytes that hold the bits of the next slice.
  size_t SliceBytes() const { return (first_bit_ + grid_.VoxelsPerSlice() + 7) / 8; }

  const VolumeHeader header_;
  const MaskGrid grid_;
  BodyReader body_;
  MaskConverter converter_;
  // The bits of the next slice, as far as they have arrived, from bit first_bit_ on. Slices
  // need not begin at a byte.
  std::vector<std::byte> packed_;
  size_t first_bit_ = 0;
  size_t filled_bytes_ = 0;  // of packed_
  std::vector<uint64_t> words_;
  int32_t next_z_ = 0;
  uint64_t received_bytes_ = 0;
  std::optional<BettiNumbers> topology_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<VolumeDecoder>> MakeMaskDecoder(const VolumeHeader& header) {
  BCCSKEL_ASSIGN_OR_RETURN(
      MaskConverter converter,
      MaskConverter::Create(header.mask->grid, {.adjacency = header.mask->adjacency,
                                                .points = header.mask->points,
                                                .max_bricks = header.max_bricks}));
  return std::make_unique<MaskDecoder>(header, std::move(converter));
}

}  // namespace bccskel
