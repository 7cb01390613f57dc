// Where headers end and voxels begin.
#include <algorithm>
#include <array>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"

namespace bccskel {
namespace {

absl::StatusOr<ImageFront> Filled(ImageFront front, const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(auto stream,
                           ByteStream::Open(front.file, front.member, front.compression));
  const bool plain = front.compression == Compression::kNone;
  const uint64_t most = plain ? front.file->size() : front.file->size() * kMaxDeflateRatio;
  front.bytes.resize(static_cast<size_t>(std::min(limits.max_header_bytes, most)));
  BCCSKEL_ASSIGN_OR_RETURN(const size_t got,
                           stream->Read(std::as_writable_bytes(std::span(front.bytes))));
  front.bytes.resize(got);
  return front;
}

}  // namespace

absl::StatusOr<ImageFront> ReadFront(std::shared_ptr<const ImageFile> file,
                                     const ImageLimits& limits) {
  std::array<std::byte, 2> magic = {};
  BCCSKEL_RETURN_IF_ERROR(file->ReadAt(0, magic).status());
  return Filled({.file = std::move(file), .compression = SniffGzip(magic), .bytes = ""}, limits);
}

absl::StatusOr<ImageFront> ReadMemberFront(std::shared_ptr<const ImageFile> file, uint64_t member,
                                           const ImageLimits& limits) {
  return Filled({std::move(file), Compression::kZip, "", member}, limits);
}

absl::StatusOr<std::shared_ptr<const ImageFile>> Expanded(std::shared_ptr<const ImageFile> file,
                                                          Compression compression) {
  if (compression == Compression::kNone) return file;
  constexpr size_t kMaxBytes = size_t{1} << 30;
  constexpr size_t kStep = size_t{1} << 20;
  BCCSKEL_ASSIGN_OR_RETURN(auto stream, ByteStream::Open(file, 0, compression));
  std::string bytes;
  for (size_t filled = 0;; filled = bytes.size()) {
    bytes.resize(filled + kStep);
    const auto into = std::as_writable_bytes(std::span(bytes)).subspan(filled);
    BCCSKEL_ASSIGN_OR_RETURN(const size_t got, stream->Read(into));
    bytes.resize(filled + got);
    if (got < kStep) return ImageFile::OfBytes(file->name(), std::move(bytes));
    if (bytes.size() >= kMaxBytes) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("a file that is compressed by gzip and must be expanded in memory may "
                          "have at most %d bytes; expand it with gunzip first",
                          kMaxBytes));
    }
  }
}

absl::Status PlaceBehindHeader(const ImageFront& front, uint64_t header_bytes, Compression inner,
                               StoredImage& image) {
  image.file = front.file;
  if (front.compression == Compression::kNone) {
    image.stream_offset = header_bytes;
    image.compression = inner;
    return absl::OkStatus();
  }
  if (inner != Compression::kNone) {
    BCCSKEL_ASSIGN_OR_RETURN(image.file, Expanded(front.file, front.compression));
    image.stream_offset = header_bytes;
    image.compression = inner;
    return absl::OkStatus();
  }
  image.compression = front.compression;
  image.stream_offset = front.member;
  image.skip = header_bytes;
  return absl::OkStatus();
}

absl::Status PlaceInFile(const ImageFront& front, std::string_view name,
                         std::optional<uint64_t> skip, Compression inner, StoredImage& image) {
  BCCSKEL_ASSIGN_OR_RETURN(image.file, front.file->OpenBeside(std::string(name)));
  image.compression = inner;
  if (skip.has_value()) {
    image.skip = *skip;
    return absl::OkStatus();
  }
  if (inner != Compression::kNone) {
    return absl::InvalidArgumentError("compressed voxels cannot be found from the file's end");
  }
  const uint64_t declared = image.VoxelBytesDeclared();
  image.stream_offset = image.file->size() - std::min(declared, image.file->size());
  return absl::OkStatus();
}

absl::Status PlaceDetached(const ImageFront& front, std::string_view name,
                           std::string_view skip_field, std::string_view skip, Compression inner,
                           StoredImage& image) {
  if (name.starts_with("LIST") || name.find('%') != name.npos) {
    return absl::UnimplementedError("voxels spread over several data files are not supported");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const int64_t bytes, RequireNumber<int64_t>(skip_field, skip));
  if (bytes < -1) return BadField(skip_field, skip, "is less than -1");
  const auto behind = bytes < 0 ? std::nullopt : std::optional(static_cast<uint64_t>(bytes));
  return PlaceInFile(front, name, behind, inner, image);
}

}  // namespace bccskel
