#include "core/io/exr_header.h"

#include <algorithm>
#include <limits>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/exr_attributes.h"
#include "core/io/little_endian.h"

namespace bccskel {
namespace {

constexpr uint32_t kExrMagic = 20000630;
constexpr uint32_t kVersionAndFlags = 2 | 0x1000;  // version 2, multi-part, flat, short names
constexpr int32_t kUintPixels = 0;
constexpr int32_t kMaxChannels = 1400;  // 22 bytes each in both parts stay below 64 KiB
constexpr size_t kMaxChannelName = 31;

struct ExrPart {
  LatticeExtent extent;
  Placement placement;
  VolumeCompression compression = VolumeCompression::kNone;
  std::optional<uint64_t> declared_bricks;
};

absl::Status CheckMagic(ByteCursor& cursor) {
  const auto magic = cursor.TakeNumber<uint32_t>();
  if (magic != kExrMagic) return absl::InvalidArgumentError("not an OpenEXR file: no magic number");
  const auto version = cursor.TakeNumber<uint32_t>();
  if (version != kVersionAndFlags) {
    return absl::InvalidArgumentError(
        absl::StrFormat("OpenEXR version and flags 0x%x: must be 0x%x (version 2, several parts, "
                        "flat, short names)",
                        version.value_or(0), kVersionAndFlags));
  }
  return absl::OkStatus();
}

absl::Status CheckText(const ExrAttributes& attributes, std::string_view name,
                       std::string_view wanted) {
  if (attributes.Text(name) == wanted) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("OpenEXR attribute %s must be '%s'", name, wanted));
}

absl::StatusOr<VolumeCompression> ReadCompression(const ExrAttributes& attributes) {
  switch (const auto code = attributes.NumberAt<uint8_t>("compression", 0)) {
    case 0:
      return VolumeCompression::kNone;
    case 1:
      return VolumeCompression::kRle;
    case 2:
      return VolumeCompression::kZips;
    case 3:
      return VolumeCompression::kZip;
    default:
      return absl::InvalidArgumentError(absl::StrFormat(
          "OpenEXR compression %d: must be 0 (none), 1 (RLE), 2 (ZIPS) or 3 (ZIP)", code));
  }
}

absl::Status CheckWindow(const ExrAttributes& attributes, std::string_view name,
                         const LatticeExtent& extent) {
  const std::array<int32_t, 4> wanted = {0, 0, extent.nx - 1, extent.ny - 1};
  for (size_t n = 0; n < wanted.size(); ++n) {
    if (const auto is = attributes.NumberAt<int32_t>(name, n); is != wanted[n]) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "OpenEXR %s: number %d is %d, must be %d for an extent of %d x %d x %d cells", name, n,
          is, wanted[n], extent.nx, extent.ny, extent.nz));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckChannel(ByteCursor& cursor, int32_t channel) {
  const auto name = cursor.TakeName(kMaxChannelName);
  if (name != ExrChannelName(channel)) {
    return absl::InvalidArgumentError(absl::StrFormat("OpenEXR channel %d must have the name %s",
                                                      channel, ExrChannelName(channel)));
  }
  const auto pixels = cursor.TakeNumber<int32_t>();
  const auto linear = cursor.TakeNumber<uint32_t>();  // one flag and three reserved bytes
  const auto x_sampling = cursor.TakeNumber<int32_t>();
  const auto y_sampling = cursor.TakeNumber<int32_t>();
  if (pixels != kUintPixels || linear != 0u || x_sampling != 1 || y_sampling != 1) {
    return absl::InvalidArgumentError(
        absl::StrFormat("OpenEXR channel %s must be of type UINT, sampled at every pixel",
                        ExrChannelName(channel)));
  }
  return absl::OkStatus();
}

absl::Status CheckChannels(const ExrAttributes& attributes, const LatticeExtent& extent) {
  ByteCursor cursor(attributes.Value("channels"));
  for (int32_t channel = 0; channel < ChannelCount(extent); ++channel) {
    BCCSKEL_RETURN_IF_ERROR(CheckChannel(cursor, channel));
  }
  const auto end = cursor.TakeName(kMaxChannelName);
  if (!end || !end->empty() || !cursor.at_end()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "OpenEXR channels: exactly %d are needed for %d layers", ChannelCount(extent), extent.nz));
  }
  return absl::OkStatus();
}

template <size_t kCount>
std::array<double, kCount> ReadDoubles(const ExrAttributes& attributes, std::string_view name) {
  std::array<double, kCount> values;
  for (size_t n = 0; n < kCount; ++n) values[n] = attributes.NumberAt<double>(name, n);
  return values;
}

absl::StatusOr<std::optional<uint64_t>> ReadBricks(const ExrAttributes& attributes) {
  if (!attributes.Has(kExrBricksAttribute)) return std::nullopt;
  const auto bricks = attributes.NumberAt<int32_t>(kExrBricksAttribute, 0);
  if (bricks < 0) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "OpenEXR attribute %s is %d: must be 0 or more", kExrBricksAttribute, bricks));
  }
  return static_cast<uint64_t>(bricks);
}

// What the profile fixes for every volume.
absl::Status CheckFixedAttributes(const ExrAttributes& attributes, std::string_view part_name) {
  BCCSKEL_RETURN_IF_ERROR(CheckText(attributes, "name", part_name));
  BCCSKEL_RETURN_IF_ERROR(CheckText(attributes, "type", "scanlineimage"));
  if (const auto order = attributes.NumberAt<uint8_t>("lineOrder", 0); order != 0) {
    return absl::InvalidArgumentError(
        absl::StrFormat("OpenEXR lineOrder %d: must be 0 (increasing y)", order));
  }
  const auto version = attributes.NumberAt<int32_t>(kExrProfileAttribute, 0);
  if (version != kExrProfileVersion) {
    return absl::InvalidArgumentError(absl::StrFormat("volume profile version %d: only %d is known",
                                                      version, kExrProfileVersion));
  }
  return absl::OkStatus();
}

absl::StatusOr<ExrPart> ReadGrid(const ExrAttributes& attributes) {
  ExrPart part;
  part.extent = {attributes.NumberAt<int32_t>(kExrExtentAttribute, 0),
                 attributes.NumberAt<int32_t>(kExrExtentAttribute, 1),
                 attributes.NumberAt<int32_t>(kExrExtentAttribute, 2)};
  part.placement = {.spacing = ReadDoubles<3>(attributes, kExrSpacingAttribute),
                    .origin = ReadDoubles<3>(attributes, kExrOriginAttribute),
                    .direction = ReadDoubles<9>(attributes, kExrDirectionAttribute)};
  BCCSKEL_ASSIGN_OR_RETURN(part.compression, ReadCompression(attributes));
  BCCSKEL_ASSIGN_OR_RETURN(part.declared_bricks, ReadBricks(attributes));
  return part;
}

absl::Status CheckPixels(const ExrAttributes& attributes, const ExrPart& part) {
  BCCSKEL_RETURN_IF_ERROR(CheckWindow(attributes, "dataWindow", part.extent));
  BCCSKEL_RETURN_IF_ERROR(CheckWindow(attributes, "displayWindow", part.extent));
  BCCSKEL_RETURN_IF_ERROR(CheckChannels(attributes, part.extent));
  const auto chunks = attributes.NumberAt<int32_t>("chunkCount", 0);
  if (const int32_t wanted = ExrChunkCount(part.extent, part.compression); chunks != wanted) {
    return absl::InvalidArgumentError(
        absl::StrFormat("OpenEXR chunkCount %d: must be %d for %d lines compressed as %s", chunks,
                        wanted, part.extent.ny, VolumeCompressionName(part.compression)));
  }
  return absl::OkStatus();
}

// The grid is checked against the limits before its channels are looked at: everything after
// CompleteVolumeHeader() may rely on sane numbers.
absl::StatusOr<VolumeHeader> ReadPart(ByteCursor& cursor, std::string_view name,
                                      const VolumeLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const ExrAttributes attributes, ExrAttributes::Read(cursor));
  BCCSKEL_RETURN_IF_ERROR(CheckFixedAttributes(attributes, name));
  BCCSKEL_ASSIGN_OR_RETURN(const ExrPart part, ReadGrid(attributes));
  BCCSKEL_ASSIGN_OR_RETURN(VolumeHeader header,
                           CompleteVolumeHeader({.encoding = VolumeEncoding::kOpenExr,
                                                 .compression = part.compression,
                                                 .extent = part.extent,
                                                 .placement = part.placement,
                                                 .declared_bricks = part.declared_bricks},
                                                limits));
  BCCSKEL_RETURN_IF_ERROR(CheckExrCanHold(part.extent, part.compression));
  BCCSKEL_RETURN_IF_ERROR(CheckPixels(attributes, part));
  return header;
}

absl::Status CheckHeadersEnd(ByteCursor& cursor) {
  const auto end = cursor.TakeName(kMaxChannelName);
  if (end && end->empty()) return absl::OkStatus();
  return absl::InvalidArgumentError("OpenEXR file: must have exactly two parts, even and odd");
}

// Of any compression: a server knows a volume's own after these sizes.
uint64_t MostExrChunks(const LatticeExtent& extent) { return static_cast<uint64_t>(extent.ny); }

}  // namespace

std::string ExrChannelName(int32_t channel) { return absl::StrFormat("z%04d", channel); }

int32_t ExrLinesPerChunk(VolumeCompression compression) {
  return compression == VolumeCompression::kZip ? 16 : 1;
}

int32_t ExrChunkCount(const LatticeExtent& extent, VolumeCompression compression) {
  const int32_t lines = ExrLinesPerChunk(compression);
  return (extent.ny + lines - 1) / lines;
}

uint64_t ExrLineBytes(const LatticeExtent& extent) {
  return static_cast<uint64_t>(extent.nx) * static_cast<uint64_t>(ChannelCount(extent)) *
         sizeof(uint32_t);
}

uint64_t ExrStripBytes(const LatticeExtent& extent, VolumeCompression compression) {
  const auto lines = static_cast<uint64_t>(ExrLinesPerChunk(compression));
  return (3 * lines + 4) * ExrLineBytes(extent) + 16 * MostExrChunks(extent) + (uint64_t{4} << 20);
}

uint64_t MaxExrBytes(const LatticeExtent& extent) {
  const uint64_t tables_and_leaders = 2 * MostExrChunks(extent) * (8 + 12);
  uint64_t sum = 0;
  const bool overflow =
      __builtin_add_overflow(DensePlaneBytes(extent), kMaxHeaderBytes + tables_and_leaders, &sum);
  return overflow ? std::numeric_limits<uint64_t>::max() : sum;
}

absl::Status CheckExrCanHold(const LatticeExtent& extent, VolumeCompression compression) {
  if (ChannelCount(extent) > kMaxChannels) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d layers: an OpenEXR volume holds at most %d; use the bricks encoding",
                        extent.nz, kMaxChannels * 32));
  }
  const uint64_t chunk =
      ExrLineBytes(extent) * static_cast<uint64_t>(ExrLinesPerChunk(compression));
  if (chunk > static_cast<uint64_t>(std::numeric_limits<int32_t>::max())) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "extent of %d x %d x %d cells: an OpenEXR chunk of %d bytes is over the format's limit of "
        "%d; use the bricks encoding",
        extent.nx, extent.ny, extent.nz, chunk, std::numeric_limits<int32_t>::max()));
  }
  return absl::OkStatus();
}

bool BeginsLikeExr(std::span<const std::byte> front) {
  return ByteCursor(front).TakeNumber<uint32_t>() == kExrMagic;
}

absl::StatusOr<ExrHeader> ScanExrHeader(std::span<const std::byte> front,
                                        const VolumeLimits& limits) {
  ByteCursor cursor(front.first(std::min(front.size(), kMaxHeaderBytes)));
  BCCSKEL_RETURN_IF_ERROR(CheckMagic(cursor));
  BCCSKEL_ASSIGN_OR_RETURN(VolumeHeader even, ReadPart(cursor, kExrPartNames[0], limits));
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader odd, ReadPart(cursor, kExrPartNames[1], limits));
  BCCSKEL_RETURN_IF_ERROR(CheckHeadersEnd(cursor));
  if (even != odd) {
    return absl::InvalidArgumentError(
        "OpenEXR parts even and odd differ in extent, placement, compression or bricks");
  }
  return ExrHeader{even, cursor.position()};
}

}  // namespace bccskel
