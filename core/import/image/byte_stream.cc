#include "core/import/image/byte_stream.h"

#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/zip_archive.h"

namespace bccskel {
namespace {

constexpr size_t kInputBytes = size_t{1} << 16;

class PlainStream : public ByteStream {
 public:
  PlainStream(std::shared_ptr<const ImageFile> file, uint64_t offset)
      : file_(std::move(file)), offset_(offset) {}

  absl::StatusOr<size_t> Read(std::span<std::byte> into) override {
    BCCSKEL_ASSIGN_OR_RETURN(const size_t got, file_->ReadAt(offset_, into));
    offset_ += got;
    return got;
  }

  absl::Status Skip(uint64_t bytes) override {
    const uint64_t rest = file_->size() - std::min(offset_, file_->size());
    if (bytes > rest) {
      return absl::InvalidArgumentError(
          absl::StrFormat("the file ends %d bytes before its voxels begin", bytes - rest));
    }
    offset_ += bytes;
    return absl::OkStatus();
  }

 private:
  std::shared_ptr<const ImageFile> file_;
  uint64_t offset_;
};

// ISA-L expands masks, which repeat much, in an eighth of zlib's time.
class DeflateStream : public ByteStream {
 public:
  DeflateStream(std::shared_ptr<const ImageFile> file, uint64_t offset)
      : file_(std::move(file)), offset_(offset), input_(kInputBytes) {}

  absl::StatusOr<size_t> Read(std::span<std::byte> into) override {
    size_t filled = 0;
    while (filled < into.size() && !ended_) {
      BCCSKEL_RETURN_IF_ERROR(Refill());
      if (!begun_) Begin();
      BCCSKEL_ASSIGN_OR_RETURN(const size_t got, Expand(into.subspan(filled)));
      filled += got;
    }
    return filled;
  }

 private:
  absl::Status Refill() {
    if (state_->avail_in > 0) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(const size_t got, file_->ReadAt(offset_, input_));
    offset_ += got;
    state_->next_in = reinterpret_cast<uint8_t*>(input_.data());
    state_->avail_in = static_cast<uint32_t>(got);
    return absl::OkStatus();
  }

  bool GzipFollows() const { return state_->avail_in > 0 && state_->next_in[0] == 0x1f; }

  void Begin() {
    isal_inflate_reset(state_.get());
    state_->crc_flag = GzipFollows() ? ISAL_GZIP : ISAL_ZLIB;
    begun_ = true;
  }

  absl::StatusOr<size_t> Expand(std::span<std::byte> into) {
    const auto room =
        static_cast<uint32_t>(std::min<size_t>(into.size(), std::numeric_limits<uint32_t>::max()));
    const uint32_t given = state_->avail_in;
    state_->next_out = reinterpret_cast<uint8_t*>(into.data());
    state_->avail_out = room;
    const int code = isal_inflate(state_.get());
    const size_t got = room - state_->avail_out;
    expanded_ += got;
    if (code != ISAL_DECOMP_OK && code != ISAL_END_INPUT) {
      return absl::InvalidArgumentError(
          absl::StrFormat("the compressed stream is damaged: %s", WrongBy(code)));
    }
    if (state_->block_state == ISAL_BLOCK_FINISH) {
      BCCSKEL_RETURN_IF_ERROR(EndMember());
    } else if (got == 0 && state_->avail_in == given) {  // nothing was left to give, or to take
      return absl::InvalidArgumentError(
          absl::StrFormat("the compressed stream is cut after %d expanded bytes", expanded_));
    }
    return got;
  }

  static const char* WrongBy(int code) {
    switch (code) {
      case ISAL_INVALID_BLOCK:
        return "invalid block";
      case ISAL_INVALID_SYMBOL:
        return "invalid code";
      case ISAL_INVALID_LOOKBACK:
        return "invalid distance too far back";
      case ISAL_INVALID_WRAPPER:
        return "incorrect header";
      case ISAL_UNSUPPORTED_METHOD:
        return "unknown compression method";
      case ISAL_INCORRECT_CHECKSUM:
        return "incorrect data check";
      default:
        return "it needs what is not in it";
    }
  }

  // Some writers put gzip members in a row; what else follows a stream is not ours.
  absl::Status EndMember() {
    BCCSKEL_RETURN_IF_ERROR(Refill());
    begun_ = false;
    ended_ = !GzipFollows();
    return absl::OkStatus();
  }

  std::shared_ptr<const ImageFile> file_;
  uint64_t offset_;
  std::vector<std::byte> input_;
  std::unique_ptr<inflate_state> state_ = std::make_unique<inflate_state>();
  uint64_t expanded_ = 0;
  bool begun_ = false;
  bool ended_ = false;
};

}  // namespace

Compression SniffGzip(std::span<const std::byte> front) {
  const bool gzip = front.size() >= 2 && front[0] == std::byte{0x1f} && front[1] == std::byte{0x8b};
  return gzip ? Compression::kDeflate : Compression::kNone;
}

absl::Status ByteStream::Skip(uint64_t bytes) {
  std::array<std::byte, 4096> dropped;
  while (bytes > 0) {
    const auto part = static_cast<size_t>(std::min<uint64_t>(bytes, dropped.size()));
    BCCSKEL_ASSIGN_OR_RETURN(const size_t got, Read(std::span(dropped).first(part)));
    if (got < part) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "the compressed stream ends %d bytes before its voxels begin", bytes - got));
    }
    bytes -= part;
  }
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<ByteStream>> ByteStream::Open(std::shared_ptr<const ImageFile> file,
                                                             uint64_t offset,
                                                             Compression compression) {
  if (compression == Compression::kNone) {
    return std::make_unique<PlainStream>(std::move(file), offset);
  }
  if (compression == Compression::kZip) return OpenZipMember(std::move(file), offset);
  return std::make_unique<DeflateStream>(std::move(file), offset);
}

}  // namespace bccskel
