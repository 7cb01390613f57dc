#ifndef BCCSKEL_CORE_IO_ENCODED_BODY_H_
#define BCCSKEL_CORE_IO_ENCODED_BODY_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/io/byte_sink.h"
#include "core/io/volume_header.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace bccskel {

// The body of planes and of bricks: bytes as they are, or one zstd frame whose window is at most
// 8 MiB, so that a reader knows what memory it needs before it begins.
inline constexpr int kMaxZstdWindowLog = 23;

// Memory that reading a body takes.
uint64_t BodyBufferBytes(VolumeCompression compression);
// No sensible encoding of `decoded_bytes` is longer. Saturates.
uint64_t MaxBodyBytes(uint64_t decoded_bytes, VolumeCompression compression);

using ByteConsumer = std::function<absl::Status(std::span<const std::byte>)>;

// Turns an encoded body that comes in parts into decoded bytes that go out in parts.
class BodyReader {
 public:
  // Needs: compression kNone or kZstd.
  explicit BodyReader(VolumeCompression compression);
  ~BodyReader();
  BodyReader(const BodyReader&) = delete;
  BodyReader& operator=(const BodyReader&) = delete;

  // Hands on what `bytes` decode to; stops at the first error of `consume`.
  // Errors: INVALID_ARGUMENT for a malformed frame or bytes after its end; consume's.
  absl::Status Append(std::span<const std::byte> bytes, const ByteConsumer& consume);
  // Errors: INVALID_ARGUMENT when the frame is cut off.
  absl::Status Finish() const;

 private:
  absl::Status Inflate(std::span<const std::byte> bytes, const ByteConsumer& consume);

  struct FreeZstd {
    void operator()(ZSTD_DCtx_s* zstd) const;
  };
  std::unique_ptr<ZSTD_DCtx_s, FreeZstd> zstd_;  // null for plain bodies
  std::unique_ptr<std::byte[]> buffer_;          // with it
  bool frame_ended_ = false;
};

// The opposite.
class BodyWriter {
 public:
  // Needs: compression kNone or kZstd.
  BodyWriter(VolumeCompression compression, SinkCursor& sink);
  ~BodyWriter();
  BodyWriter(const BodyWriter&) = delete;
  BodyWriter& operator=(const BodyWriter&) = delete;

  // Errors: the sink's.
  absl::Status Write(std::span<const std::byte> bytes);
  absl::Status Finish();

 private:
  enum class Flow { kContinue, kEnd };
  absl::Status Deflate(std::span<const std::byte> bytes, Flow flow);

  struct FreeZstd {
    void operator()(ZSTD_CCtx_s* zstd) const;
  };
  SinkCursor& sink_;
  std::unique_ptr<ZSTD_CCtx_s, FreeZstd> zstd_;  // null for plain bodies
  std::vector<std::byte> buffer_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_ENCODED_BODY_H_
