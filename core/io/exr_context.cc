#include "core/io/exr_context.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

constexpr uint64_t kUnlimited = std::numeric_limits<uint64_t>::max();

// OpenEXR's allocation hooks get nothing but a size, so what is left of the budget belongs to the
// thread. Each block remembers its size in front of it.
thread_local uint64_t budget_left = kUnlimited;
constexpr size_t kBlockHeader = alignof(std::max_align_t);

void* AllocateInBudget(size_t bytes) {
  if (bytes > budget_left || bytes > kUnlimited - kBlockHeader) return nullptr;
  void* block = std::malloc(bytes + kBlockHeader);
  if (block == nullptr) return nullptr;
  std::memcpy(block, &bytes, sizeof(bytes));
  budget_left -= bytes;
  return static_cast<std::byte*>(block) + kBlockHeader;
}

void FreeInBudget(void* memory) {
  if (memory == nullptr) return;
  void* block = static_cast<std::byte*>(memory) - kBlockHeader;
  size_t bytes = 0;
  std::memcpy(&bytes, block, sizeof(bytes));
  budget_left += bytes;
  std::free(block);
}

}  // namespace

ExrContext::~ExrContext() {
  if (context_ != nullptr) exr_finish(&context_);
  budget_left = kUnlimited;
}

exr_context_initializer_t ExrContext::Initializer() {
  exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
  initializer.error_handler_fn = &ExrContext::OnError;
  initializer.alloc_fn = &AllocateInBudget;
  initializer.free_fn = &FreeInBudget;
  initializer.user_data = this;
  return initializer;
}

absl::Status ExrContext::OpenForReading(std::span<const std::byte> file, uint64_t budget_bytes) {
  file_ = file;
  budget_left = budget_bytes;
  exr_context_initializer_t initializer = Initializer();
  initializer.read_fn = &ExrContext::Read;
  initializer.size_fn = &ExrContext::FileSize;
  initializer.flags =
      EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  return Check(exr_start_read(&context_, "volume", &initializer), "header");
}

absl::Status ExrContext::OpenForWriting(ByteSink& sink) {
  sink_ = &sink;
  exr_context_initializer_t initializer = Initializer();
  initializer.write_fn = &ExrContext::Write;
  return Check(exr_start_write(&context_, "volume", EXR_WRITE_FILE_DIRECTLY, &initializer),
               "start");
}

absl::Status ExrContext::Finish() {
  // exr_finish() reports no error if it cannot write the tables, so ask the sink.
  absl::Status finished = Check(exr_finish(&context_), "end of file");
  BCCSKEL_RETURN_IF_ERROR(sink_status_);
  return finished;
}

absl::Status ExrContext::Check(exr_result_t result, const char* what) const {
  if (result == EXR_ERR_SUCCESS) return absl::OkStatus();
  BCCSKEL_RETURN_IF_ERROR(sink_status_);
  const std::string said = absl::StrFormat(
      "OpenEXR %s: %s", what, message_.empty() ? exr_get_default_error_message(result) : message_);
  if (result == EXR_ERR_OUT_OF_MEMORY) return absl::ResourceExhaustedError(said);
  return sink_ == nullptr ? absl::InvalidArgumentError(said) : absl::InternalError(said);
}

// The first message is the cause, later ones its consequences.
void ExrContext::OnError(exr_const_context_t context, exr_result_t, const char* message) {
  void* self = nullptr;
  if (exr_get_user_data(context, &self) != EXR_ERR_SUCCESS || self == nullptr) return;
  std::string& kept = static_cast<ExrContext*>(self)->message_;
  if (kept.empty() && message != nullptr) kept = std::string(message).substr(0, 256);
}

int64_t ExrContext::Read(exr_const_context_t, void* self, void* buffer, uint64_t bytes,
                         uint64_t offset, exr_stream_error_func_ptr_t) {
  const auto file = static_cast<const ExrContext*>(self)->file_;
  if (offset > file.size()) return -1;
  const uint64_t count = std::min<uint64_t>(bytes, file.size() - offset);
  if (count > 0) std::memcpy(buffer, file.data() + offset, count);
  return static_cast<int64_t>(count);
}

int64_t ExrContext::FileSize(exr_const_context_t, void* self) {
  return static_cast<int64_t>(static_cast<const ExrContext*>(self)->file_.size());
}

int64_t ExrContext::Write(exr_const_context_t, void* self, const void* buffer, uint64_t bytes,
                          uint64_t offset, exr_stream_error_func_ptr_t) {
  auto* context = static_cast<ExrContext*>(self);
  if (!context->sink_status_.ok()) return -1;
  context->sink_status_ =
      context->sink_->WriteAt(offset, {static_cast<const std::byte*>(buffer), bytes});
  return context->sink_status_.ok() ? static_cast<int64_t>(bytes) : -1;
}

}  // namespace bccskel
