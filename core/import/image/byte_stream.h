#ifndef BCCSKEL_CORE_IMPORT_IMAGE_BYTE_STREAM_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_BYTE_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/image_file.h"

namespace bccskel {

enum class Compression {
  kNone,
  kDeflate,  // gzip or zlib, distinguished by the first bytes; also several gzip members in a row
  kZip,      // a member of a zip archive, stored or deflated; its number stands for an offset
};

// No deflate stream expands its bytes by more than this.
inline constexpr uint64_t kMaxDeflateRatio = 1032;

// kDeflate where the bytes begin as gzip does.
Compression SniffGzip(std::span<const std::byte> front);

// The bytes of a file from a place on, expanded, in order. Memory: 150 KiB.
class ByteStream {
 public:
  static absl::StatusOr<std::unique_ptr<ByteStream>> Open(std::shared_ptr<const ImageFile> file,
                                                          uint64_t offset, Compression compression);
  virtual ~ByteStream() = default;

  // How many bytes were read: fewer than asked for only at the end.
  // Errors: INVALID_ARGUMENT for a damaged or truncated stream; errors of the system.
  virtual absl::StatusOr<size_t> Read(std::span<std::byte> into) = 0;

  // Passes over bytes, by reading them where there is no better way.
  // Errors: as Read(); INVALID_ARGUMENT where the stream ends before.
  virtual absl::Status Skip(uint64_t bytes);
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_BYTE_STREAM_H_
