#include "tests/server/support/raw_call.h"

#include <utility>

#include "core/exec/status_macros.h"
#include "proto/wire/error_details.h"
#include "proto/wire/skeleton_chunks.h"

namespace bccskel::test {
namespace {

template <typename Request, typename Response>
RepliesOf<Response> ConverseBy(RawCallOf<Request, Response>& call,
                               const std::vector<Request>& requests) {
  call.SendAll(requests);
  RepliesOf<Response> replies;
  while (auto response = call.Receive()) replies.responses.push_back(*std::move(response));
  replies.status = call.Finish();
  return replies;
}

}  // namespace

Replies Converse(const std::shared_ptr<grpc::Channel>& channel,
                 const std::vector<v1::SkeletonizeRequest>& requests) {
  RawCall call(channel);
  return ConverseBy(call, requests);
}

LabelsReplies Converse(const std::shared_ptr<grpc::Channel>& channel,
                       const std::vector<v1::SkeletonizeLabelsRequest>& requests) {
  RawLabelsCall call(channel);
  return ConverseBy(call, requests);
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

absl::StatusOr<std::vector<LabelSkeleton>> SkeletonsOf(const LabelsReplies& replies) {
  BCCSKEL_RETURN_IF_ERROR(replies.status);
  std::vector<LabelSkeleton> skeletons;
  wire::SkeletonAssembler assembler;
  uint64_t label = 0;  // whose chunks came last; 0, the background, is no label
  for (const v1::SkeletonizeLabelsResponse& response : replies.responses) {
    if (response.has_skeleton_chunk()) {
      if (label != 0 && label != response.skeleton_chunk().label()) {
        return absl::DataLossError("a chunk of another label came before the summary");
      }
      label = response.skeleton_chunk().label();
      BCCSKEL_RETURN_IF_ERROR(assembler.Add(response.skeleton_chunk().chunk()));
    } else if (response.has_label_summary()) {
      const v1::LabelSummary& summary = response.label_summary();
      if (label != summary.label()) return absl::DataLossError("a summary of another label");
      LabelSkeleton& skeleton = skeletons.emplace_back();
      skeleton.label = summary.label();
      skeleton.voxels = summary.voxels();
      BCCSKEL_ASSIGN_OR_RETURN(skeleton.result,
                               std::exchange(assembler, {}).Finish(summary.summary()));
      label = 0;
    }
  }
  if (replies.responses.empty() || !replies.responses.back().has_labels_summary()) {
    return absl::DataLossError("the last reply is no summary");
  }
  return skeletons;
}

absl::Status FromGrpcStatus(const grpc::Status& status) {
  v1::Status details;
  if (!status.error_details().empty() && details.ParseFromString(status.error_details())) {
    return wire::FromRpcStatus(details);
  }
  return absl::Status(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
}

}  // namespace bccskel::test
