#ifndef BCCSKEL_CORE_IO_VOLUME_HEADER_H_
#define BCCSKEL_CORE_IO_VOLUME_HEADER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/lattice/lattice_point.h"
#include "core/mask/mask_grid.h"

namespace bccskel {

// The forms of a volume outside memory. README.md in this folder pins their bytes.
enum class VolumeEncoding {
  kOpenExr,    // two-part OpenEXR file
  kRawPlanes,  // the bit planes of the two sublattices, without any header
  kBricks,     // coordinates and bits of the occupied bricks
  kCubicMask,  // the voxels of a cubic mask, a bit each: decoding converts it; nothing is encoded
               // so
};
std::string_view VolumeEncodingName(VolumeEncoding encoding);

// OpenEXR knows kNone, kRle, kZips and kZip; the others know kNone and kZstd.
enum class VolumeCompression { kNone, kRle, kZips, kZip, kZstd };
std::string_view VolumeCompressionName(VolumeCompression compression);
// Errors: INVALID_ARGUMENT when the encoding does not have the compression.
absl::Status CheckCompression(VolumeEncoding encoding, VolumeCompression compression);

// What a reader is willing to take. Everything is checked from the header, before memory is taken
// for it; the number of bricks again while decoding.
struct VolumeLimits {
  int32_t max_extent_cells = kMaxExtentCells;      // along each axis
  uint64_t max_bricks = uint64_t{1} << 24;         // 64 bytes each
  uint64_t max_decoded_bytes = uint64_t{4} << 30;  // what decompression may yield
};

// A header fits in the first bytes of an encoding, whatever it declares.
inline constexpr size_t kMaxHeaderBytes = size_t{64} * 1024;

// A cubic mask that becomes a volume by the exact conversion of core/mask.
struct MaskDeclaration {
  MaskGrid grid;
  MaskAdjacency adjacency = MaskAdjacency::k26;
  VoxelPoints points = VoxelPoints::kTwo;

  friend bool operator==(const MaskDeclaration&, const MaskDeclaration&) = default;
};

// What is known about a volume before anything is decompressed.
struct VolumeHeader {
  VolumeEncoding encoding = VolumeEncoding::kOpenExr;
  VolumeCompression compression = VolumeCompression::kNone;
  LatticeExtent extent;
  Placement placement;
  // Of kCubicMask only; extent and placement follow from it.
  std::optional<MaskDeclaration> mask = std::nullopt;
  std::optional<uint64_t> declared_bricks;  // a promise of the sender, enforced while decoding

  // Derived from the above.
  uint64_t max_bricks = 0;         // most bricks that decoding can yield
  uint64_t decoded_bytes = 0;      // bytes after decompression: the bits of the box, or the bricks
  uint64_t max_encoded_bytes = 0;  // no well-formed encoding is longer
  uint64_t strip_bytes = 0;        // buffers of the decoder beside bricks and encoded bytes

  // Peak memory of decoding `encoded_bytes` bytes: strips, bricks (twice, while they are put in
  // order) and what has to be kept of the encoding.
  uint64_t DecodingBytes(uint64_t encoded_bytes) const;

  friend bool operator==(const VolumeHeader&, const VolumeHeader&) = default;
};

// Which encoding these bytes begin. Raw planes have no mark and are never the answer.
// Errors: INVALID_ARGUMENT when it is none of ours.
absl::StatusOr<VolumeEncoding> SniffVolumeEncoding(std::span<const std::byte> front);

// Reads the header of an OpenEXR or bricks encoding and checks it against the profile and limits.
// Shapes: `front` is the first min(kMaxHeaderBytes, length) bytes of the encoding, or more.
// Errors: INVALID_ARGUMENT for bytes that are malformed or outside the profile, and for raw planes
//         and masks, which have no header; RESOURCE_EXHAUSTED for a volume over `limits`.
absl::StatusOr<VolumeHeader> ScanVolumeHeader(VolumeEncoding encoding,
                                              std::span<const std::byte> front,
                                              const VolumeLimits& limits);

// Checks grid and limits and fills in the derived fields.
// Errors: as ScanVolumeHeader().
absl::StatusOr<VolumeHeader> CompleteVolumeHeader(VolumeHeader header, const VolumeLimits& limits);

// Words of 32 layers that a column of nz cells needs; channels of an OpenEXR part.
constexpr int32_t ChannelCount(const LatticeExtent& extent) { return (extent.nz + 31) / 32; }

// Bytes of a mask with a bit per voxel. Needs: a checked grid.
uint64_t MaskBytes(const MaskGrid& grid);

// Bytes of the bit planes of both sublattices; saturates at the largest uint64_t.
uint64_t DensePlaneBytes(const LatticeExtent& extent);

// Bricks of both sublattices that cover the extent.
uint64_t BoxBrickCount(const LatticeExtent& extent);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_VOLUME_HEADER_H_
