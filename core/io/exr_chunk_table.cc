#include <algorithm>
#include <cstdint>

#include "absl/status/statusor.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/exr_header.h"
#include "core/io/little_endian.h"

namespace bccskel {
namespace {

constexpr size_t kOffsetBytes = 8;
constexpr size_t kLeaderBytes = 12;  // part, first line, size

struct ExrChunk {
  int32_t part = 0;
  int32_t index = 0;
  uint64_t offset = 0;  // of the leader in the file
};

absl::Status ChunkError(const ExrChunk& chunk, const char* what, int64_t value, int64_t wanted) {
  return absl::InvalidArgumentError(
      absl::StrFormat("OpenEXR chunk %d of part %s: %s is %d, must be %d", chunk.index,
                      kExrPartNames[static_cast<size_t>(chunk.part)], what, value, wanted));
}

uint64_t UnpackedBytes(const VolumeHeader& volume, int32_t first_line) {
  const int32_t lines =
      std::min(ExrLinesPerChunk(volume.compression), volume.extent.ny - first_line);
  return static_cast<uint64_t>(lines) * ExrLineBytes(volume.extent);
}

absl::Status CheckSize(const VolumeHeader& volume, const ExrChunk& chunk, int32_t first_line,
                       int64_t size) {
  const auto unpacked = static_cast<int64_t>(UnpackedBytes(volume, first_line));
  if (volume.compression == VolumeCompression::kNone && size != unpacked) {
    return ChunkError(chunk, "size", size, unpacked);
  }
  if (size < 1 || size > unpacked) {
    return absl::InvalidArgumentError(
        absl::StrFormat("OpenEXR chunk %d of part %s: size is %d, must be 1 to %d", chunk.index,
                        kExrPartNames[static_cast<size_t>(chunk.part)], size, unpacked));
  }
  return absl::OkStatus();
}

// The bytes that the chunk takes in the file, leader included.
absl::StatusOr<uint64_t> CheckChunk(std::span<const std::byte> file, const VolumeHeader& volume,
                                    const ExrChunk& chunk, uint64_t tables_end) {
  const uint64_t file_bytes = file.size();
  if (chunk.offset < tables_end || chunk.offset > file_bytes ||
      file_bytes - chunk.offset < kLeaderBytes) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "OpenEXR chunk %d of part %s: offset %d lies outside the file of %d bytes", chunk.index,
        kExrPartNames[static_cast<size_t>(chunk.part)], chunk.offset, file_bytes));
  }
  const auto leader = file.subspan(chunk.offset, kLeaderBytes);
  const auto part = LoadNumber<int32_t>(leader, 0);
  const auto line = LoadNumber<int32_t>(leader, 4);
  const int64_t size = LoadNumber<int32_t>(leader, 8);
  const int32_t wanted_line = chunk.index * ExrLinesPerChunk(volume.compression);
  if (part != chunk.part) return ChunkError(chunk, "part", part, chunk.part);
  if (line != wanted_line) return ChunkError(chunk, "first line", line, wanted_line);
  BCCSKEL_RETURN_IF_ERROR(CheckSize(volume, chunk, line, size));
  const uint64_t bytes = kLeaderBytes + static_cast<uint64_t>(size);
  if (bytes > file_bytes - chunk.offset) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "OpenEXR chunk %d of part %s is cut off: the file has %d bytes, needs %d", chunk.index,
        kExrPartNames[static_cast<size_t>(chunk.part)], file_bytes, chunk.offset + bytes));
  }
  return bytes;
}

}  // namespace

absl::Status CheckExrChunks(std::span<const std::byte> file, const ExrHeader& header) {
  const VolumeHeader& volume = header.volume;
  const int32_t chunks = ExrChunkCount(volume.extent, volume.compression);
  const uint64_t tables_end =
      header.header_bytes + 2 * kOffsetBytes * static_cast<uint64_t>(chunks);
  if (file.size() < tables_end) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "OpenEXR file of %d bytes is cut off in the chunk tables, which end at byte %d",
        file.size(), tables_end));
  }
  uint64_t used = tables_end;
  size_t entry = header.header_bytes;
  for (int32_t part = 0; part < 2; ++part) {
    for (int32_t index = 0; index < chunks; ++index, entry += kOffsetBytes) {
      const ExrChunk chunk = {part, index, LoadNumber<uint64_t>(file, entry)};
      BCCSKEL_ASSIGN_OR_RETURN(const uint64_t bytes, CheckChunk(file, volume, chunk, tables_end));
      used += bytes;
    }
  }
  if (used != file.size()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "OpenEXR file has %d bytes: header, tables and chunks take %d", file.size(), used));
  }
  return absl::OkStatus();
}

}  // namespace bccskel
