#include "core/io/volume_header.h"

#include <algorithm>
#include <limits>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/bricks_header.h"
#include "core/io/encoded_body.h"
#include "core/io/exr_header.h"
#include "core/volume/volume.h"

namespace bccskel {
namespace {

constexpr uint64_t kSaturated = std::numeric_limits<uint64_t>::max();

uint64_t SaturatingMultiply(uint64_t a, uint64_t b) {
  uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? kSaturated : product;
}

uint64_t SaturatingAdd(uint64_t a, uint64_t b) {
  uint64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? kSaturated : sum;
}

absl::Status CheckExtentLimit(const LatticeExtent& extent, const VolumeLimits& limits) {
  if (std::max({extent.nx, extent.ny, extent.nz}) <= limits.max_extent_cells) {
    return absl::OkStatus();
  }
  return absl::ResourceExhaustedError(
      absl::StrFormat("extent of %d x %d x %d cells: the limit is %d cells along each axis",
                      extent.nx, extent.ny, extent.nz, limits.max_extent_cells));
}

absl::Status CheckMask(const VolumeHeader& header) {
  if (header.mask.has_value() == (header.encoding == VolumeEncoding::kCubicMask)) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError("a cubic mask, and nothing else, declares its voxels");
}

absl::Status CheckDeclaredBricks(const VolumeHeader& header, const VolumeLimits& limits) {
  if (!header.declared_bricks) {
    if (header.encoding != VolumeEncoding::kBricks) return absl::OkStatus();
    return absl::InvalidArgumentError("a bricks encoding must declare the number of its bricks");
  }
  const uint64_t box = BoxBrickCount(header.extent);
  if (*header.declared_bricks > box) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%d bricks declared, but only %d fit in the extent", *header.declared_bricks, box));
  }
  if (*header.declared_bricks > limits.max_bricks) {
    return absl::ResourceExhaustedError(absl::StrFormat(
        "%d bricks declared: the limit is %d", *header.declared_bricks, limits.max_bricks));
  }
  return absl::OkStatus();
}

absl::Status CheckDecodedBytes(const VolumeHeader& header, const VolumeLimits& limits) {
  const bool fits = header.decoded_bytes <= limits.max_decoded_bytes;
  if (fits && header.decoded_bytes != kSaturated) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrFormat(
      "extent of %d x %d x %d cells as %s decodes to %d bytes: the limit is %d", header.extent.nx,
      header.extent.ny, header.extent.nz, VolumeEncodingName(header.encoding), header.decoded_bytes,
      limits.max_decoded_bytes));
}

// A slice as bits, and the slices that conversion and topology look back on.
uint64_t MaskStripBytes(const MaskGrid& grid) {
  constexpr uint64_t kSlices = 13;
  return SaturatingMultiply(kSlices * sizeof(uint64_t), grid.WordsPerSlice());
}

// The sizes that depend on the encoding. Needs: a checked grid.
void DeriveSizes(VolumeHeader& header) {
  switch (header.encoding) {
    case VolumeEncoding::kOpenExr:
      header.decoded_bytes = DensePlaneBytes(header.extent);
      header.strip_bytes = ExrStripBytes(header.extent, header.compression);
      header.max_encoded_bytes = MaxExrBytes(header.extent);
      return;
    case VolumeEncoding::kRawPlanes:
      header.decoded_bytes = DensePlaneBytes(header.extent);
      header.strip_bytes = static_cast<uint64_t>(header.extent.nx) * 4 * sizeof(uint32_t) +
                           BodyBufferBytes(header.compression);
      header.max_encoded_bytes = MaxBodyBytes(header.decoded_bytes, header.compression);
      return;
    case VolumeEncoding::kCubicMask:
      header.decoded_bytes = MaskBytes(header.mask->grid);
      header.strip_bytes =
          SaturatingAdd(MaskStripBytes(header.mask->grid), BodyBufferBytes(header.compression));
      header.max_encoded_bytes = MaxBodyBytes(header.decoded_bytes, header.compression);
      return;
    case VolumeEncoding::kBricks:
      header.decoded_bytes = SaturatingMultiply(*header.declared_bricks, kBrickRecordBytes);
      header.strip_bytes = BodyBufferBytes(header.compression);
      header.max_encoded_bytes =
          SaturatingAdd(kBricksHeaderBytes, MaxBodyBytes(header.decoded_bytes, header.compression));
      return;
  }
}

}  // namespace

std::string_view VolumeEncodingName(VolumeEncoding encoding) {
  switch (encoding) {
    case VolumeEncoding::kOpenExr:
      return "OpenEXR";
    case VolumeEncoding::kRawPlanes:
      return "raw planes";
    case VolumeEncoding::kBricks:
      return "bricks";
    case VolumeEncoding::kCubicMask:
      return "cubic mask";
  }
  return "unknown";
}

std::string_view VolumeCompressionName(VolumeCompression compression) {
  switch (compression) {
    case VolumeCompression::kNone:
      return "none";
    case VolumeCompression::kRle:
      return "RLE";
    case VolumeCompression::kZips:
      return "ZIPS";
    case VolumeCompression::kZip:
      return "ZIP";
    case VolumeCompression::kZstd:
      return "zstd";
  }
  return "unknown";
}

absl::Status CheckCompression(VolumeEncoding encoding, VolumeCompression compression) {
  const bool exr = encoding == VolumeEncoding::kOpenExr;
  const bool zstd = compression == VolumeCompression::kZstd;
  if (compression == VolumeCompression::kNone || exr != zstd) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s compressed as %s: must be %s", VolumeEncodingName(encoding),
      VolumeCompressionName(compression), exr ? "none, RLE, ZIPS or ZIP" : "none or zstd"));
}

uint64_t DensePlaneBytes(const LatticeExtent& extent) {
  const uint64_t plane = static_cast<uint64_t>(extent.nx) * static_cast<uint64_t>(extent.ny);
  const uint64_t words = 2 * static_cast<uint64_t>(ChannelCount(extent));
  return SaturatingMultiply(plane, words * sizeof(uint32_t));
}

uint64_t MaskBytes(const MaskGrid& grid) {
  const uint64_t voxels = SaturatingMultiply(grid.VoxelsPerSlice(), static_cast<uint64_t>(grid.nz));
  return voxels / 8 + (voxels % 8 != 0 ? 1 : 0);
}

uint64_t BoxBrickCount(const LatticeExtent& extent) {
  const auto bricks = [](int32_t cells, int32_t edge) {
    return (static_cast<uint64_t>(cells) + static_cast<uint64_t>(edge) - 1) /
           static_cast<uint64_t>(edge);
  };
  return 2 * bricks(extent.nx, kBrickX) * bricks(extent.ny, kBrickY) * bricks(extent.nz, kBrickZ);
}

uint64_t VolumeHeader::DecodingBytes(uint64_t encoded_bytes) const {
  const uint64_t bricks =
      SaturatingMultiply(max_bricks, 2 * (sizeof(BrickBits) + sizeof(BrickKey)));
  const uint64_t kept = encoding == VolumeEncoding::kOpenExr ? encoded_bytes : 0;
  return SaturatingAdd(SaturatingAdd(bricks, strip_bytes), kept);
}

absl::StatusOr<VolumeHeader> CompleteVolumeHeader(VolumeHeader header, const VolumeLimits& limits) {
  BCCSKEL_RETURN_IF_ERROR(CheckGrid(header.extent, header.placement));
  BCCSKEL_RETURN_IF_ERROR(CheckMask(header));
  BCCSKEL_RETURN_IF_ERROR(CheckCompression(header.encoding, header.compression));
  BCCSKEL_RETURN_IF_ERROR(CheckExtentLimit(header.extent, limits));
  BCCSKEL_RETURN_IF_ERROR(CheckDeclaredBricks(header, limits));
  DeriveSizes(header);
  BCCSKEL_RETURN_IF_ERROR(CheckDecodedBytes(header, limits));
  header.max_bricks =
      header.declared_bricks.value_or(std::min(BoxBrickCount(header.extent), limits.max_bricks));
  return header;
}

absl::StatusOr<VolumeEncoding> SniffVolumeEncoding(std::span<const std::byte> front) {
  if (BeginsLikeExr(front)) return VolumeEncoding::kOpenExr;
  if (BeginsLikeBricks(front)) return VolumeEncoding::kBricks;
  return absl::InvalidArgumentError(
      "not a volume: the first bytes are neither those of an OpenEXR file nor those of a bricks "
      "file");
}

absl::StatusOr<VolumeHeader> ScanVolumeHeader(VolumeEncoding encoding,
                                              std::span<const std::byte> front,
                                              const VolumeLimits& limits) {
  switch (encoding) {
    case VolumeEncoding::kOpenExr: {
      BCCSKEL_ASSIGN_OR_RETURN(ExrHeader exr, ScanExrHeader(front, limits));
      return exr.volume;
    }
    case VolumeEncoding::kBricks:
      return ScanBricksHeader(front, limits);
    case VolumeEncoding::kRawPlanes:
    case VolumeEncoding::kCubicMask:
      break;
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("%s have no header: extent and placement are declared beside them",
                      VolumeEncodingName(encoding)));
}

}  // namespace bccskel
