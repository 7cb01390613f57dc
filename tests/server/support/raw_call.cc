#include "tests/server/support/raw_call.h"

#include <utility>

#include "core/exec/status_macros.h"
#include "proto/wire/error_details.h"
#include "proto/wire/skeleton_chunks.h"

namespace bccskel::test {

RawCall::RawCall(const std::shared_ptr<grpc::Channel>& channel, std::chrono::milliseconds timeout)
    : stub_(v1::SkeletonizationService::NewStub(channel)) {
  context_.set_deadline(std::chrono::system_clock::now() + timeout);
  context_.set_wait_for_ready(true);
  stream_ = stub_->Skeletonize(&context_);
}

std::optional<v1::SkeletonizeResponse> RawCall::Receive() {
  v1::SkeletonizeResponse response;
  if (!stream_->Read(&response)) return std::nullopt;
  return response;
}

absl::Status RawCall::Finish() {
  while (Receive().has_value()) {
  }
  return FromGrpcStatus(stream_->Finish());
}

Replies Converse(const std::shared_ptr<grpc::Channel>& channel,
                 const std::vector<v1::SkeletonizeRequest>& requests) {
  RawCall call(channel);
  bool open = true;
  for (const v1::SkeletonizeRequest& request : requests) open = open && call.Send(request);
  if (open) call.CloseSending();
  Replies replies;
  while (auto response = call.Receive()) replies.responses.push_back(*std::move(response));
  replies.status = call.Finish();
  return replies;
}

absl::StatusOr<SkeletonizeResult> SkeletonOf(const Replies& replies) {
  BCCSKEL_RETURN_IF_ERROR(replies.status);
  wire::SkeletonAssembler assembler;
  for (const v1::SkeletonizeResponse& response : replies.responses) {
    if (!response.has_skeleton_chunk()) continue;
    BCCSKEL_RETURN_IF_ERROR(assembler.Add(response.skeleton_chunk()));
  }
  if (replies.responses.empty() || !replies.responses.back().has_summary()) {
    return absl::DataLossError("the last reply is no summary");
  }
  return std::move(assembler).Finish(replies.responses.back().summary());
}

std::string ThinVolumeOf(const Replies& replies) {
  std::string bytes;
  for (const v1::SkeletonizeResponse& response : replies.responses) {
    if (response.has_thin_volume_chunk()) bytes += response.thin_volume_chunk().data();
  }
  return bytes;
}

absl::Status FromGrpcStatus(const grpc::Status& status) {
  v1::Status details;
  if (!status.error_details().empty() && details.ParseFromString(status.error_details())) {
    return wire::FromRpcStatus(details);
  }
  return absl::Status(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
}

}  // namespace bccskel::test
