#include "core/image/byte_stream.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

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

class DeflateStream : public ByteStream {
 public:
  DeflateStream(std::shared_ptr<const ImageFile> file, uint64_t offset)
      : file_(std::move(file)), offset_(offset), input_(kInputBytes) {}
  ~DeflateStream() override { inflateEnd(&zlib_); }

  absl::Status Start() {
    constexpr int kGzipOrZlib = 15 + 32;
    if (inflateInit2(&zlib_, kGzipOrZlib) == Z_OK) return absl::OkStatus();
    return absl::ResourceExhaustedError("not enough memory to expand a compressed stream");
  }

  absl::StatusOr<size_t> Read(std::span<std::byte> into) override {
    size_t filled = 0;
    while (filled < into.size() && !ended_) {
      BCCSKEL_RETURN_IF_ERROR(Refill());
      BCCSKEL_ASSIGN_OR_RETURN(const size_t got, Expand(into.subspan(filled)));
      filled += got;
    }
    return filled;
  }

  absl::Status Skip(uint64_t bytes) override {
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

 private:
  absl::Status Refill() {
    if (zlib_.avail_in > 0) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(const size_t got, file_->ReadAt(offset_, input_));
    offset_ += got;
    zlib_.next_in = reinterpret_cast<Bytef*>(input_.data());
    zlib_.avail_in = static_cast<uInt>(got);
    return absl::OkStatus();
  }

  absl::StatusOr<size_t> Expand(std::span<std::byte> into) {
    const auto room =
        static_cast<uInt>(std::min<size_t>(into.size(), std::numeric_limits<uInt>::max()));
    const bool no_more_input = zlib_.avail_in == 0;
    zlib_.next_out = reinterpret_cast<Bytef*>(into.data());
    zlib_.avail_out = room;
    const int code = inflate(&zlib_, Z_NO_FLUSH);
    const size_t got = room - zlib_.avail_out;
    if (code == Z_STREAM_END) BCCSKEL_RETURN_IF_ERROR(EndMember());
    if (code == Z_OK || code == Z_STREAM_END) return got;
    if (code == Z_BUF_ERROR && no_more_input) {
      return absl::InvalidArgumentError(
          absl::StrFormat("the compressed stream is cut after %d expanded bytes", zlib_.total_out));
    }
    if (code == Z_BUF_ERROR) return got;
    return absl::InvalidArgumentError(absl::StrFormat(
        "the compressed stream is damaged: %s", zlib_.msg == nullptr ? "no reason" : zlib_.msg));
  }

  // Some writers put gzip members in a row; what else follows a stream is not ours.
  absl::Status EndMember() {
    BCCSKEL_RETURN_IF_ERROR(Refill());
    const bool another = zlib_.avail_in >= 1 && zlib_.next_in[0] == 0x1f;
    ended_ = !another || inflateReset(&zlib_) != Z_OK;
    return absl::OkStatus();
  }

  std::shared_ptr<const ImageFile> file_;
  uint64_t offset_;
  std::vector<std::byte> input_;
  z_stream zlib_ = {};
  bool ended_ = false;
};

}  // namespace

Compression SniffGzip(std::span<const std::byte> front) {
  const bool gzip = front.size() >= 2 && front[0] == std::byte{0x1f} && front[1] == std::byte{0x8b};
  return gzip ? Compression::kDeflate : Compression::kNone;
}

absl::StatusOr<std::unique_ptr<ByteStream>> ByteStream::Open(std::shared_ptr<const ImageFile> file,
                                                             uint64_t offset,
                                                             Compression compression) {
  if (compression == Compression::kNone) {
    return std::make_unique<PlainStream>(std::move(file), offset);
  }
  auto stream = std::make_unique<DeflateStream>(std::move(file), offset);
  BCCSKEL_RETURN_IF_ERROR(stream->Start());
  return stream;
}

}  // namespace bccskel
