#include "server/calls/request_sequence.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

constexpr size_t kDigestBytes = 32;

absl::Status WrongSize(const std::string& field, const std::string& message) {
  return CallError(Reason::kVolumeSize, message, {.field = field});
}

}  // namespace

absl::Status RequestSequence::UnknownRequest() {
  return InvalidField("request", "holds neither config nor chunk nor finish");
}

absl::Status RequestSequence::HalfClose() const {
  if (finished()) return absl::OkStatus();
  if (expected_ == Expected::kConfig) {
    return CallError(Reason::kRequestOrder,
                     "the stream was closed, or a request cannot be parsed, before config");
  }
  return CallError(Reason::kVolumeTruncated,
                   absl::StrCat("the stream was closed without finish, or a request cannot be "
                                "parsed, after ",
                                committed_bytes_, " of ", declared_bytes_, " declared bytes"));
}

absl::Status RequestSequence::TakeConfig(uint64_t declared_bytes) {
  BCCSKEL_RETURN_IF_ERROR(CheckExpected(Expected::kConfig, "config"));
  expected_ = Expected::kBytes;
  declared_bytes_ = declared_bytes;
  return absl::OkStatus();
}

absl::Status RequestSequence::TakeChunk(const v1::VolumeChunk& chunk) {
  BCCSKEL_RETURN_IF_ERROR(CheckExpected(Expected::kBytes, "chunk"));
  if (chunk.offset() != committed_bytes_) {
    return WrongOffset(absl::StrCat("chunk at offset ", chunk.offset(), ", ", committed_bytes_,
                                    " bytes were received so far"),
                       committed_bytes_);
  }
  const size_t size = chunk.data().size();
  if (size > kMaxChunkBytes) {
    return InvalidField("chunk.data", absl::StrCat(size, " bytes, the limit is ", kMaxChunkBytes));
  }
  if (size > declared_bytes_ - committed_bytes_) {
    return WrongSize("chunk.data", absl::StrCat("more than the declared ", declared_bytes_,
                                                " bytes of the volume"));
  }
  committed_bytes_ += size;
  return absl::OkStatus();
}

absl::Status RequestSequence::TakeFinish(const v1::VolumeFinish& finish) {
  BCCSKEL_RETURN_IF_ERROR(CheckExpected(Expected::kBytes, "finish"));
  if (finish.size_bytes() != committed_bytes_ || committed_bytes_ != declared_bytes_) {
    return WrongSize("finish.size_bytes",
                     absl::StrCat("finish states ", finish.size_bytes(), " bytes, ",
                                  committed_bytes_, " came, ", declared_bytes_, " were declared"));
  }
  if (!finish.sha256().empty() && finish.sha256().size() != kDigestBytes) {
    return InvalidField("finish.sha256",
                        absl::StrCat(finish.sha256().size(), " bytes, must be ", kDigestBytes));
  }
  expected_ = Expected::kNothing;
  return absl::OkStatus();
}

absl::Status RequestSequence::CheckExpected(Expected expected, const char* request) const {
  if (expected == expected_) return absl::OkStatus();
  const char* const place = expected_ == Expected::kConfig  ? "before config"
                            : expected_ == Expected::kBytes ? "after config"
                                                            : "after finish";
  return CallError(Reason::kRequestOrder, absl::StrCat(request, " came ", place));
}

}  // namespace bccskel::server
