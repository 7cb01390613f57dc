#ifndef BCCSKEL_CORE_IO_EXR_HEADER_H_
#define BCCSKEL_CORE_IO_EXR_HEADER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "core/io/volume_header.h"

namespace bccskel {

// The OpenEXR profile of a volume (README.md): what the writer writes and all that the reader
// takes.
inline constexpr int32_t kExrProfileVersion = 1;
inline constexpr std::array<const char*, 2> kExrPartNames = {"even", "odd"};
inline constexpr const char* kExrProfileAttribute = "bccProfile";      // int
inline constexpr const char* kExrExtentAttribute = "bccExtent";        // v3i
inline constexpr const char* kExrSpacingAttribute = "bccSpacing";      // v3d
inline constexpr const char* kExrOriginAttribute = "bccOrigin";        // v3d
inline constexpr const char* kExrDirectionAttribute = "bccDirection";  // m33d, row-major
inline constexpr const char* kExrBricksAttribute = "bccBricks";        // int, may be missing

// "z0000", "z0001", ...
std::string ExrChannelName(int32_t channel);

// Scan lines that one chunk holds, and chunks of a part.
int32_t ExrLinesPerChunk(VolumeCompression compression);
int32_t ExrChunkCount(const LatticeExtent& extent, VolumeCompression compression);
// Bytes of one scan line: all channels.
uint64_t ExrLineBytes(const LatticeExtent& extent);
// Buffers of the decoder: a chunk as stored, decompressed and in between, four lines, the tables.
uint64_t ExrStripBytes(const LatticeExtent& extent, VolumeCompression compression);
// No file of the profile is longer. Saturates.
uint64_t MaxExrBytes(const LatticeExtent& extent);
// Errors: INVALID_ARGUMENT when OpenEXR cannot hold a volume of this extent: a chunk over 2 GiB, or
//         more channels than fit in the header.
absl::Status CheckExrCanHold(const LatticeExtent& extent, VolumeCompression compression);

struct ExrHeader {
  VolumeHeader volume;
  size_t header_bytes = 0;  // where the chunk offset tables begin
};

bool BeginsLikeExr(std::span<const std::byte> front);

// Reads the headers of both parts without OpenEXR, whose parser would take memory and time for
// whatever a header claims.
// Errors: as ScanVolumeHeader().
absl::StatusOr<ExrHeader> ScanExrHeader(std::span<const std::byte> front,
                                        const VolumeLimits& limits);

// Checks the chunk offset tables and the 12 bytes in front of every chunk of a whole file: each
// chunk lies where its table says, belongs to its part and line, has a size that its compression
// can have, and all chunks together fill the file to its last byte. OpenEXR itself would take a
// chunk of no bytes for one of whatever its buffer held before.
// Errors: INVALID_ARGUMENT.
absl::Status CheckExrChunks(std::span<const std::byte> file, const ExrHeader& header);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_EXR_HEADER_H_
