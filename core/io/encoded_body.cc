#include "core/io/encoded_body.h"

#include <zstd.h>

#include <limits>
#include <mutex>
#include <new>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

constexpr size_t kBufferBytes = 128 * 1024;
constexpr int kLevel = 1;  // the bit planes shrink hardly more at higher ones
constexpr uint64_t kZstdContextBytes = (uint64_t{1} << kMaxZstdWindowLog) + (uint64_t{1} << 20);

// Making a context and its window takes longer than inflating a small volume, so a few are kept,
// unless their windows are larger than our own writer's.
class SpareContexts {
 public:
  ZSTD_DCtx* Take() {
    std::lock_guard lock(mutex_);
    if (spare_.empty()) return ZSTD_createDCtx();
    ZSTD_DCtx* const last = spare_.back();
    spare_.pop_back();
    return last;
  }

  void Give(ZSTD_DCtx* context) {
    ZSTD_DCtx_reset(context, ZSTD_reset_session_and_parameters);
    std::lock_guard lock(mutex_);
    if (spare_.size() < kMost && ZSTD_sizeof_DCtx(context) <= kMostBytes) {
      spare_.push_back(context);
    } else {
      ZSTD_freeDCtx(context);
    }
  }

 private:
  static constexpr size_t kMost = 4;
  static constexpr size_t kMostBytes = 1 << 20;

  std::mutex mutex_;
  std::vector<ZSTD_DCtx*> spare_;  // guarded by mutex_
};

SpareContexts& Contexts() {
  static auto* const contexts = new SpareContexts;  // for threads that outlive main(), too
  return *contexts;
}

absl::Status MalformedError(size_t code) {
  return absl::InvalidArgumentError(
      absl::StrFormat("zstd frame: %s (the window must be at most %d MiB)", ZSTD_getErrorName(code),
                      (1 << kMaxZstdWindowLog) >> 20));
}

}  // namespace

uint64_t BodyBufferBytes(VolumeCompression compression) {
  return compression == VolumeCompression::kZstd ? kBufferBytes + kZstdContextBytes : 0;
}

uint64_t MaxBodyBytes(uint64_t decoded_bytes, VolumeCompression compression) {
  if (compression != VolumeCompression::kZstd) return decoded_bytes;
  // Blocks that do not shrink are stored; a writer that flushes small blocks pays 3 bytes for each.
  const uint64_t slack = decoded_bytes / 8 + 64 * 1024;
  uint64_t sum = 0;
  return __builtin_add_overflow(decoded_bytes, slack, &sum) ? std::numeric_limits<uint64_t>::max()
                                                            : sum;
}

void BodyReader::FreeZstd::operator()(ZSTD_DCtx_s* zstd) const { Contexts().Give(zstd); }
void BodyWriter::FreeZstd::operator()(ZSTD_CCtx_s* zstd) const { ZSTD_freeCCtx(zstd); }

BodyReader::BodyReader(VolumeCompression compression) {
  if (compression != VolumeCompression::kZstd) return;
  zstd_.reset(Contexts().Take());
  if (zstd_ == nullptr) throw std::bad_alloc();
  ZSTD_DCtx_setParameter(zstd_.get(), ZSTD_d_windowLogMax, kMaxZstdWindowLog);
  buffer_ = std::make_unique_for_overwrite<std::byte[]>(kBufferBytes);
}

BodyReader::~BodyReader() = default;

absl::Status BodyReader::Append(std::span<const std::byte> bytes, const ByteConsumer& consume) {
  return zstd_ == nullptr ? consume(bytes) : Inflate(bytes, consume);
}

absl::Status BodyReader::Inflate(std::span<const std::byte> bytes, const ByteConsumer& consume) {
  ZSTD_inBuffer in = {bytes.data(), bytes.size(), 0};
  bool buffer_filled = true;  // more may be waiting inside zstd although all input is taken
  while (in.pos < in.size || (buffer_filled && !frame_ended_)) {
    if (frame_ended_) {
      return absl::InvalidArgumentError(
          absl::StrFormat("%d bytes after the end of the zstd frame", in.size - in.pos));
    }
    ZSTD_outBuffer out = {buffer_.get(), kBufferBytes, 0};
    const size_t result = ZSTD_decompressStream(zstd_.get(), &out, &in);
    if (ZSTD_isError(result)) return MalformedError(result);
    frame_ended_ = result == 0;
    buffer_filled = out.pos == out.size;
    if (out.pos > 0) BCCSKEL_RETURN_IF_ERROR(consume(std::span(buffer_.get(), out.pos)));
  }
  return absl::OkStatus();
}

absl::Status BodyReader::Finish() const {
  if (zstd_ == nullptr || frame_ended_) return absl::OkStatus();
  return absl::InvalidArgumentError("the zstd frame is cut off");
}

BodyWriter::BodyWriter(VolumeCompression compression, SinkCursor& sink) : sink_(sink) {
  if (compression != VolumeCompression::kZstd) return;
  zstd_.reset(ZSTD_createCCtx());
  ZSTD_CCtx_setParameter(zstd_.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(zstd_.get(), ZSTD_c_checksumFlag, 1);
  buffer_.resize(kBufferBytes);
}

BodyWriter::~BodyWriter() = default;

absl::Status BodyWriter::Write(std::span<const std::byte> bytes) {
  return zstd_ == nullptr ? sink_.Write(bytes) : Deflate(bytes, Flow::kContinue);
}

absl::Status BodyWriter::Finish() {
  return zstd_ == nullptr ? absl::OkStatus() : Deflate({}, Flow::kEnd);
}

absl::Status BodyWriter::Deflate(std::span<const std::byte> bytes, Flow flow) {
  ZSTD_inBuffer in = {bytes.data(), bytes.size(), 0};
  const auto directive = flow == Flow::kEnd ? ZSTD_e_end : ZSTD_e_continue;
  size_t waiting = 1;
  while (flow == Flow::kEnd ? waiting != 0 : in.pos < in.size) {
    ZSTD_outBuffer out = {buffer_.data(), buffer_.size(), 0};
    waiting = ZSTD_compressStream2(zstd_.get(), &out, &in, directive);
    if (ZSTD_isError(waiting)) {
      return absl::InternalError(absl::StrFormat("zstd: %s", ZSTD_getErrorName(waiting)));
    }
    BCCSKEL_RETURN_IF_ERROR(sink_.Write(std::span(buffer_).first(out.pos)));
  }
  return absl::OkStatus();
}

}  // namespace bccskel
