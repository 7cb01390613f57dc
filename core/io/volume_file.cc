#include "core/io/volume_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <span>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "core/exec/descriptor.h"
#include "core/exec/status_macros.h"
#include "core/exec/worker_team.h"
#include "core/io/brick_collector.h"
#include "core/io/bricks_header.h"
#include "core/io/file_replacement.h"
#include "core/io/volume_decoders.h"
#include "core/io/volume_encoder.h"

namespace bccskel {
namespace {

constexpr size_t kReadBytes = 1 << 20;
static_assert(kReadBytes >= kMaxHeaderBytes);

absl::Status SystemError(const char* what) { return absl::ErrnoToStatus(errno, what); }

absl::Status InFile(const std::string& path, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrFormat("%s: %s", path, status.message()));
}

// Reads until `buffer` is full or the file ends.
absl::StatusOr<std::span<const std::byte>> ReadSome(const exec::Descriptor& file,
                                                    std::span<std::byte> buffer) {
  size_t filled = 0;
  while (filled < buffer.size()) {
    const ssize_t count = read(file.get(), buffer.data() + filled, buffer.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return SystemError("cannot read");
    if (count == 0) break;
    filled += static_cast<size_t>(count);
  }
  return buffer.first(filled);
}

absl::StatusOr<EncodeVolumeOptions> EncodingFor(const std::string& path) {
  if (absl::EndsWithIgnoreCase(path, ".exr")) {
    return EncodeVolumeOptions{.encoding = VolumeEncoding::kOpenExr,
                               .compression = VolumeCompression::kZip};
  }
  if (absl::EndsWithIgnoreCase(path, ".bccb")) {
    return EncodeVolumeOptions{.encoding = VolumeEncoding::kBricks,
                               .compression = VolumeCompression::kZstd};
  }
  return absl::InvalidArgumentError(
      "the name of a volume file must end in .exr (OpenEXR) or .bccb (bricks)");
}

// The share of the records that lie at their places in the file.
absl::StatusOr<Volume> ReadRecords(const exec::Descriptor& file, const VolumeHeader& header,
                                   const LayerPart& share, const exec::Context& context) {
  struct stat status = {};
  if (fstat(file.get(), &status) != 0) return SystemError("cannot read");
  const uint64_t count = *header.declared_bricks;
  if (static_cast<uint64_t>(status.st_size) != kBricksHeaderBytes + count * kBrickRecordBytes) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d bricks declared, but the file has %d bytes", count, status.st_size));
  }
  const exec::Share records = exec::ShareOf(count, share.index, share.count);
  const auto start = static_cast<off_t>(kBricksHeaderBytes + records.begin * kBrickRecordBytes);
  if (lseek(file.get(), start, SEEK_SET) < 0) return SystemError("cannot read");
  BrickCollector collector(header);
  std::vector<std::byte> buffer(kReadBytes / kBrickRecordBytes * kBrickRecordBytes);
  for (uint64_t n = records.begin; n < records.end;) {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    const size_t wanted = std::min(buffer.size(), (records.end - n) * kBrickRecordBytes);
    BCCSKEL_ASSIGN_OR_RETURN(std::span<const std::byte> some,
                             ReadSome(file, std::span(buffer).first(wanted)));
    if (some.size() != wanted) return absl::DataLossError("the file became shorter");
    for (; !some.empty(); some = some.subspan(kBrickRecordBytes), ++n) {
      BCCSKEL_ASSIGN_OR_RETURN(const BrickRecord record,
                               ParseBrickRecord(n, some.first(kBrickRecordBytes)));
      BCCSKEL_RETURN_IF_ERROR(collector.AddBrick(record.key, record.bits));
    }
  }
  return std::move(collector).Build();
}

absl::StatusOr<Volume> DecodeFile(const exec::Descriptor& file, const LayerPart& share,
                                  const VolumeLimits& limits, const exec::Context& context) {
  std::vector<std::byte> buffer(kReadBytes);
  BCCSKEL_ASSIGN_OR_RETURN(std::span<const std::byte> part, ReadSome(file, buffer));
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeEncoding encoding, SniffVolumeEncoding(part));
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader header, ScanVolumeHeader(encoding, part, limits));
  std::unique_ptr<VolumeDecoder> decoder;
  if (encoding == VolumeEncoding::kBricks) {
    const bool in_place = header.compression == VolumeCompression::kNone && share.count > 1;
    if (in_place) return ReadRecords(file, header, share, context);
    decoder = MakeBricksDecoder(header, limits, share);
  } else {
    if (share.index > 0) return Volume::FromSortedBricks(header.extent, header.placement, {}, {});
    BCCSKEL_ASSIGN_OR_RETURN(decoder, MakeVolumeDecoder(header, limits));
  }
  while (!part.empty()) {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    BCCSKEL_RETURN_IF_ERROR(decoder->Append(part));
    BCCSKEL_ASSIGN_OR_RETURN(part, ReadSome(file, buffer));
  }
  return decoder->Finish(context);
}

absl::Status ReplaceFile(const std::string& path, const Volume& volume,
                         const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const EncodeVolumeOptions encoding, EncodingFor(path));
  BCCSKEL_ASSIGN_OR_RETURN(const std::unique_ptr<FileReplacement> file,
                           FileReplacement::Begin(path));
  BCCSKEL_RETURN_IF_ERROR(EncodeVolumeTo(volume, encoding, *file, context));
  return file->Commit(context.stop);
}

}  // namespace

absl::StatusOr<Volume> ReadVolumeFile(const std::string& path, const VolumeLimits& limits,
                                      const exec::Context& context) {
  return ReadVolumePart(path, {}, limits, context);
}

absl::StatusOr<Volume> ReadVolumePart(const std::string& path, const LayerPart& part,
                                      const VolumeLimits& limits, const exec::Context& context) {
  const exec::Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) return InFile(path, SystemError("cannot open"));
  absl::StatusOr<Volume> volume = DecodeFile(file, part, limits, context);
  if (!volume.ok()) return InFile(path, volume.status());
  return volume;
}

absl::Status WriteVolumeFile(const std::string& path, const Volume& volume,
                             const exec::Context& context) {
  const absl::Status written = ReplaceFile(path, volume, context);
  return written.ok() ? written : InFile(path, written);
}

}  // namespace bccskel
