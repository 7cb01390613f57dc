#include "core/io/byte_sink.h"

#include <cstring>

#include "core/exec/status_macros.h"

namespace bccskel {

absl::Status StringSink::WriteAt(uint64_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return absl::OkStatus();
  if (offset == text_.size()) {
    text_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return absl::OkStatus();
  }
  if (offset + bytes.size() > text_.size()) text_.resize(offset + bytes.size());
  std::memcpy(text_.data() + offset, bytes.data(), bytes.size());
  return absl::OkStatus();
}

absl::Status SinkCursor::Write(std::span<const std::byte> bytes) {
  BCCSKEL_RETURN_IF_ERROR(sink_.WriteAt(offset_, bytes));
  offset_ += bytes.size();
  return absl::OkStatus();
}

}  // namespace bccskel
