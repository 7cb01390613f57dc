#ifndef BCCSKEL_CORE_IO_BRICKS_HEADER_H_
#define BCCSKEL_CORE_IO_BRICKS_HEADER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "absl/status/statusor.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// The bricks encoding: 160 bytes of header, then a record of 80 bytes for every brick. README.md
// has the table of fields.
inline constexpr size_t kBricksHeaderBytes = 160;
inline constexpr size_t kBrickRecordBytes = 80;
inline constexpr uint32_t kBricksVersion = 1;

bool BeginsLikeBricks(std::span<const std::byte> front);

// Errors: as ScanVolumeHeader().
absl::StatusOr<VolumeHeader> ScanBricksHeader(std::span<const std::byte> front,
                                              const VolumeLimits& limits);

// Negative zeros of the placement are written as zeros, so that equal volumes have equal bytes.
// Needs: compression kNone or kZstd.
std::array<std::byte, kBricksHeaderBytes> EncodeBricksHeader(const Volume& volume,
                                                             VolumeCompression compression);

std::array<std::byte, kBrickRecordBytes> EncodeBrickRecord(BrickKey key, const BrickBits& bits);

// What record number `number` of an encoding says.
// Shapes: kBrickRecordBytes. Errors: INVALID_ARGUMENT.
struct BrickRecord {
  BrickKey key;
  BrickBits bits;
};
absl::StatusOr<BrickRecord> ParseBrickRecord(uint64_t number, std::span<const std::byte> record);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_BRICKS_HEADER_H_
