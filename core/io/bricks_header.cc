#include "core/io/bricks_header.h"

#include <algorithm>
#include <cstring>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/little_endian.h"

namespace bccskel {
namespace {

// The line ends and the control Z show a transfer that takes the file for text.
constexpr std::array<std::byte, 8> kMagic = {std::byte{'B'},  std::byte{'C'},  std::byte{'C'},
                                             std::byte{'B'},  std::byte{0x0d}, std::byte{0x0a},
                                             std::byte{0x1a}, std::byte{0x0a}};

// Offsets of the fields.
constexpr size_t kVersionAt = 8, kCompressionAt = 12, kExtentAt = 16, kReservedAt = 28;
constexpr size_t kCountAt = 32, kSpacingAt = 40, kOriginAt = 64, kDirectionAt = 88;
static_assert(kDirectionAt + 9 * sizeof(double) == kBricksHeaderBytes);

constexpr uint32_t kPlainCode = 0, kZstdCode = 1;

template <size_t kCount>
std::array<double, kCount> LoadDoubles(std::span<const std::byte> bytes, size_t offset) {
  std::array<double, kCount> values;
  for (size_t n = 0; n < kCount; ++n) values[n] = LoadNumber<double>(bytes, offset + 8 * n);
  return values;
}

void StoreDoubles(std::span<const double> values, std::span<std::byte> bytes, size_t offset) {
  for (size_t n = 0; n < values.size(); ++n) {
    StoreNumber(values[n] + 0.0, bytes, offset + 8 * n);  // -0.0 + 0.0 is 0.0
  }
}

absl::Status CheckFrame(std::span<const std::byte> front) {
  if (!BeginsLikeBricks(front)) {
    return absl::InvalidArgumentError("not a bricks encoding: no magic number");
  }
  if (front.size() < kBricksHeaderBytes) {
    return absl::InvalidArgumentError(
        absl::StrFormat("bricks header cut off: %d of %d bytes", front.size(), kBricksHeaderBytes));
  }
  if (const auto version = LoadNumber<uint32_t>(front, kVersionAt); version != kBricksVersion) {
    return absl::InvalidArgumentError(
        absl::StrFormat("bricks version %d: only %d is known", version, kBricksVersion));
  }
  if (const auto reserved = LoadNumber<uint32_t>(front, kReservedAt); reserved != 0) {
    return absl::InvalidArgumentError(
        absl::StrFormat("bricks header: reserved field is %d, must be 0", reserved));
  }
  return absl::OkStatus();
}

absl::StatusOr<VolumeCompression> ReadCompression(std::span<const std::byte> front) {
  switch (const auto code = LoadNumber<uint32_t>(front, kCompressionAt)) {
    case kPlainCode:
      return VolumeCompression::kNone;
    case kZstdCode:
      return VolumeCompression::kZstd;
    default:
      return absl::InvalidArgumentError(
          absl::StrFormat("bricks compression %d: must be 0 (none) or 1 (zstd)", code));
  }
}

constexpr int32_t kMaxBrickCoordinate =
    (1 << 21) - 3;  // what the fields of a BrickKey can tell apart

bool FitsBrickKey(const BrickCoordinates& brick) {
  const auto fits = [](int32_t v) { return v >= 0 && v <= kMaxBrickCoordinate; };
  return fits(brick.bx) && fits(brick.by) && fits(brick.bz);
}

}  // namespace

bool BeginsLikeBricks(std::span<const std::byte> front) {
  return front.size() >= kMagic.size() && std::ranges::equal(front.first(kMagic.size()), kMagic);
}

absl::StatusOr<VolumeHeader> ScanBricksHeader(std::span<const std::byte> front,
                                              const VolumeLimits& limits) {
  BCCSKEL_RETURN_IF_ERROR(CheckFrame(front));
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeCompression compression, ReadCompression(front));
  return CompleteVolumeHeader(
      {.encoding = VolumeEncoding::kBricks,
       .compression = compression,
       .extent = {LoadNumber<int32_t>(front, kExtentAt), LoadNumber<int32_t>(front, kExtentAt + 4),
                  LoadNumber<int32_t>(front, kExtentAt + 8)},
       .placement = {.spacing = LoadDoubles<3>(front, kSpacingAt),
                     .origin = LoadDoubles<3>(front, kOriginAt),
                     .direction = LoadDoubles<9>(front, kDirectionAt)},
       .declared_bricks = LoadNumber<uint64_t>(front, kCountAt)},
      limits);
}

std::array<std::byte, kBricksHeaderBytes> EncodeBricksHeader(const Volume& volume,
                                                             VolumeCompression compression) {
  std::array<std::byte, kBricksHeaderBytes> header = {};
  std::ranges::copy(kMagic, header.begin());
  StoreNumber(kBricksVersion, header, kVersionAt);
  StoreNumber(compression == VolumeCompression::kZstd ? kZstdCode : kPlainCode, header,
              kCompressionAt);
  StoreNumber(volume.extent().nx, header, kExtentAt);
  StoreNumber(volume.extent().ny, header, kExtentAt + 4);
  StoreNumber(volume.extent().nz, header, kExtentAt + 8);
  StoreNumber(static_cast<uint64_t>(volume.brick_count()), header, kCountAt);
  StoreDoubles(volume.placement().spacing, header, kSpacingAt);
  StoreDoubles(volume.placement().origin, header, kOriginAt);
  StoreDoubles(volume.placement().direction, header, kDirectionAt);
  return header;
}

std::array<std::byte, kBrickRecordBytes> EncodeBrickRecord(BrickKey key, const BrickBits& bits) {
  std::array<std::byte, kBrickRecordBytes> record;
  const BrickCoordinates brick = key.coordinates();
  StoreNumber(brick.bx, record, 0);
  StoreNumber(brick.by, record, 4);
  StoreNumber(brick.bz, record, 8);
  StoreNumber(static_cast<uint32_t>(brick.sublattice), record, 12);
  std::memcpy(record.data() + 16, bits.words.data(), sizeof(bits.words));
  return record;
}

absl::StatusOr<BrickRecord> ParseBrickRecord(uint64_t number, std::span<const std::byte> record) {
  const auto sublattice = LoadNumber<uint32_t>(record, 12);
  if (sublattice > 1) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "brick record %d: sublattice %d must be 0 (even) or 1 (odd)", number, sublattice));
  }
  const BrickCoordinates brick = {LoadNumber<int32_t>(record, 0), LoadNumber<int32_t>(record, 4),
                                  LoadNumber<int32_t>(record, 8),
                                  static_cast<Sublattice>(sublattice)};
  if (!FitsBrickKey(brick)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("brick record %d: brick (%d, %d, %d), each coordinate must be 0 to %d",
                        number, brick.bx, brick.by, brick.bz, kMaxBrickCoordinate));
  }
  BrickRecord parsed = {BrickKey(brick), {}};
  std::memcpy(parsed.bits.words.data(), record.data() + 16, sizeof(parsed.bits.words));
  return parsed;
}

}  // namespace bccskel
