#include "server/durable/upload_table.h"

#include "absl/strings/str_cat.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

absl::Status UploadSession::Begin() {
  if (writing_) {
    return CallError(Reason::kSecondWriter, absl::StrCat(row_.name, " is being written"));
  }
  writing_ = true;
  return absl::OkStatus();
}

absl::Status UploadSession::BeginAppend(uint64_t offset, uint64_t size) {
  std::lock_guard lock(mutex_);
  if (!writing_ && offset != committed_) {
    return WrongOffset(absl::StrCat("chunk at offset ", offset, " of ", row_.name, ", which has ",
                                    committed_, " bytes"),
                       committed_);
  }
  if (!writing_ && size > row_.size_bytes - committed_) {
    return WrongOffset(absl::StrCat(size, " bytes after ", committed_, " are more than the ",
                                    row_.size_bytes, " that were declared"),
                       committed_);
  }
  return Begin();
}

absl::Status UploadSession::BeginFinish(uint64_t size) {
  std::lock_guard lock(mutex_);
  if (size != row_.size_bytes) {
    return CallError(
        Reason::kVolumeSize,
        absl::StrCat("finish states ", size, " bytes, ", row_.size_bytes, " were declared"),
        {.field = "finish.size_bytes"});
  }
  if (!writing_ && committed_ != size) {
    return WrongOffset(absl::StrCat(row_.name, " has ", committed_, " of ", size, " bytes"),
                       committed_);
  }
  return Begin();
}

}  // namespace bccskel::server
