#ifndef BCCSKEL_CORE_IO_EXR_CONTEXT_H_
#define BCCSKEL_CORE_IO_EXR_CONTEXT_H_

#include <openexr.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "core/io/byte_sink.h"

namespace bccskel {

// An OpenEXRCore context that reads from memory or writes to a sink. OpenEXR's messages end up in
// Check(), never on stderr; what it allocates counts against a budget.
// Threads: one, the same from construction to destruction (the budget belongs to the thread).
class ExrContext {
 public:
  ExrContext() = default;
  ExrContext(const ExrContext&) = delete;
  ExrContext& operator=(const ExrContext&) = delete;
  ~ExrContext();

  // One of the two, once. `file` and `sink` must outlive the context.
  // Errors: INVALID_ARGUMENT for a file that OpenEXR does not take.
  absl::Status OpenForReading(std::span<const std::byte> file, uint64_t budget_bytes);
  absl::Status OpenForWriting(ByteSink& sink);

  // Ends writing: the offset tables go out.
  absl::Status Finish();

  exr_context_t get() const { return context_; }

  // OK for EXR_ERR_SUCCESS, otherwise an error with the message of OpenEXR: the sink's own error
  // where there is one; INVALID_ARGUMENT while reading, since the bytes are the caller's;
  // RESOURCE_EXHAUSTED when the budget is spent; INTERNAL while writing.
  absl::Status Check(exr_result_t result, const char* what) const;

 private:
  static void OnError(exr_const_context_t context, exr_result_t code, const char* message);
  static int64_t Read(exr_const_context_t context, void* self, void* buffer, uint64_t bytes,
                      uint64_t offset, exr_stream_error_func_ptr_t error);
  static int64_t FileSize(exr_const_context_t context, void* self);
  static int64_t Write(exr_const_context_t context, void* self, const void* buffer, uint64_t bytes,
                       uint64_t offset, exr_stream_error_func_ptr_t error);
  exr_context_initializer_t Initializer();

  exr_context_t context_ = nullptr;
  std::span<const std::byte> file_;
  ByteSink* sink_ = nullptr;
  absl::Status sink_status_;
  std::string message_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_EXR_CONTEXT_H_
