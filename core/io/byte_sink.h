#ifndef BCCSKEL_CORE_IO_BYTE_SINK_H_
#define BCCSKEL_CORE_IO_BYTE_SINK_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "absl/status/status.h"

namespace bccskel {

// Where an encoder writes. OpenEXR goes back to fill in its offset tables, so places are named.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual absl::Status WriteAt(uint64_t offset, std::span<const std::byte> bytes) = 0;
};

class StringSink final : public ByteSink {
 public:
  absl::Status WriteAt(uint64_t offset, std::span<const std::byte> bytes) override;
  std::string Take() && { return std::move(text_); }

 private:
  std::string text_;
};

// Appends to a sink.
class SinkCursor {
 public:
  explicit SinkCursor(ByteSink& sink) : sink_(sink) {}
  absl::Status Write(std::span<const std::byte> bytes);

 private:
  ByteSink& sink_;
  uint64_t offset_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_BYTE_SINK_H_
