#include "core/import/mesh/stored_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

// No byte of deflate stands for more.
constexpr uint64_t kMostExpansion = 1032;
constexpr uint64_t kMostAtOnce = uint64_t{1} << 31;  // as long as a file may be; fits zlib's counts

absl::Status TooFewBytesError(uint64_t wanted, uint64_t found) {
  return absl::InvalidArgumentError(
      absl::StrFormat("encoded data: %d bytes are declared, %d follow", wanted, found));
}

absl::Status InflateError(std::string_view why, uint64_t stored, uint64_t size) {
  return absl::InvalidArgumentError(
      absl::StrFormat("zlib data of %d bytes, to hold %d: %s", stored, size, why));
}

struct InflateStream : z_stream {
  InflateStream() : z_stream{} { ready = inflateInit2(this, 15 + 32) == Z_OK; }  // zlib or gzip
  ~InflateStream() { inflateEnd(this); }
  InflateStream(const InflateStream&) = delete;
  InflateStream& operator=(const InflateStream&) = delete;
  bool ready = false;
};

}  // namespace

// Four characters make three bytes, fewer where padding ends the piece.
absl::Status StoredBytes::Decode(uint64_t wanted) {
  const uint64_t characters = (wanted + 2) / 3 * 4;
  std::string piece;
  size_t at = 0;
  for (; at < rest_.size() && piece.size() < characters; ++at) {
    const char c = rest_[at];
    if (absl::ascii_isspace(static_cast<unsigned char>(c))) continue;
    piece.push_back(c);
  }
  rest_.remove_prefix(at);
  std::string bytes;
  if (piece.size() % 4 != 0 || !absl::Base64Unescape(piece, &bytes)) {
    return absl::InvalidArgumentError(
        "encoded data: is not base64, or its length is no multiple of 4 characters");
  }
  decoded_ += bytes;
  return absl::OkStatus();
}

absl::StatusOr<std::string> StoredBytes::Take(uint64_t size) {
  if (size > decoded_.size() + rest_.size()) {
    return TooFewBytesError(size, decoded_.size() + rest_.size());
  }
  if (encoding_ == Encoding::kRaw) {
    std::string taken(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return taken;
  }
  if (decoded_.size() < size) {
    BCCSKEL_RETURN_IF_ERROR(Decode(size - decoded_.size()));
    if (decoded_.size() < size) return TooFewBytesError(size, decoded_.size());
  }
  std::string taken = decoded_.substr(0, size);
  decoded_.erase(0, size);
  return taken;
}

absl::StatusOr<std::string> StoredBytes::TakeAll() {
  if (encoding_ == Encoding::kRaw) return Take(rest_.size());
  BCCSKEL_RETURN_IF_ERROR(Decode(rest_.size()));
  return std::exchange(decoded_, {});
}

absl::StatusOr<std::string> Inflate(std::string_view stored, uint64_t size) {
  if (std::max<uint64_t>(stored.size(), size) > kMostAtOnce ||
      size > kMostExpansion * stored.size()) {
    return InflateError("so many are not possible", stored.size(), size);
  }
  InflateStream stream;
  if (!stream.ready) return absl::ResourceExhaustedError("not enough memory to expand zlib data");
  std::string bytes(size, '\0');
  char none = 0;  // zlib refuses a null pointer
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stored.data()));
  stream.avail_in = static_cast<uInt>(stored.size());
  stream.next_out = reinterpret_cast<Bytef*>(size == 0 ? &none : bytes.data());
  stream.avail_out = static_cast<uInt>(size);
  const int ended = inflate(&stream, Z_FINISH);
  if (ended == Z_STREAM_END && stream.avail_out == 0) return bytes;
  const bool full = stream.avail_out == 0;
  return InflateError(stream.msg != nullptr ? stream.msg
                      : full                ? "holds more, or its check sum is missing"
                                            : "is cut",
                      stored.size(), size);
}

}  // namespace bccskel
