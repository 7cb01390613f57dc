#ifndef BCCSKEL_TESTS_SERVER_SUPPORT_RAW_CALL_H_
#define BCCSKEL_TESTS_SERVER_SUPPORT_RAW_CALL_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "core/labels/skeletonize_labels.h"
#include "core/pipeline/skeletonize.h"
#include "server/server.h"
#include "tests/server/support/running_server.h"

namespace bccskel::test {

absl::Status FromGrpcStatus(const grpc::Status& status);

// One call, taken step by step, with nothing of the client library in between.
template <typename Request, typename Response>
class RawCallOf {
 public:
  explicit RawCallOf(const std::shared_ptr<grpc::Channel>& channel,
                     std::chrono::milliseconds timeout = std::chrono::minutes(2))
      : stub_(v1::SkeletonizationService::NewStub(channel)) {
    context_.set_deadline(std::chrono::system_clock::now() + timeout);
    context_.set_wait_for_ready(true);
    if constexpr (std::is_same_v<Request, v1::SkeletonizeRequest>) {
      stream_ = stub_->Skeletonize(&context_);
    } else {
      stream_ = stub_->SkeletonizeLabels(&context_);
    }
  }

  // False when the call has ended.
  bool Send(const Request& request) { return stream_->Write(request); }
  // A whole conversation. False when the call has ended before.
  bool SendAll(const std::vector<Request>& requests) {
    for (const Request& request : requests) {
      if (!Send(request)) return false;
    }
    stream_->WritesDone();
    return true;
  }
  // Nothing when the call has ended.
  std::optional<Response> Receive() {
    Response response;
    if (!stream_->Read(&response)) return std::nullopt;
    return response;
  }
  void Cancel() { context_.TryCancel(); }
  // Reads what is left and says how the call ended, with the details as payloads.
  absl::Status Finish() {
    while (Receive().has_value()) {
    }
    return FromGrpcStatus(stream_->Finish());
  }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<v1::SkeletonizationService::Stub> stub_;
  std::unique_ptr<grpc::ClientReaderWriter<Request, Response>> stream_;
};
using RawCall = RawCallOf<v1::SkeletonizeRequest, v1::SkeletonizeResponse>;
using RawLabelsCall = RawCallOf<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>;

// A whole conversation.
template <typename Response>
struct RepliesOf {
  std::vector<Response> responses;
  absl::Status status;
};
using Replies = RepliesOf<v1::SkeletonizeResponse>;
using LabelsReplies = RepliesOf<v1::SkeletonizeLabelsResponse>;
Replies Converse(const std::shared_ptr<grpc::Channel>& channel,
                 const std::vector<v1::SkeletonizeRequest>& requests);
LabelsReplies Converse(const std::shared_ptr<grpc::Channel>& channel,
                       const std::vector<v1::SkeletonizeLabelsRequest>& requests);

// On a connection of its own.
template <typename Request>
auto Converse(const server::Server& server, const std::vector<Request>& requests) {
  return Converse(ConnectTo(server.address()), requests);
}

// The skeleton that the replies make, checked as clients check it; `thin` stays empty.
absl::StatusOr<SkeletonizeResult> SkeletonOf(const Replies& replies);
// The bytes of the thinned volume.
std::string ThinVolumeOf(const Replies& replies);

// The skeletons that the replies make, in the order in which they came, checked in the same way.
absl::StatusOr<std::vector<LabelSkeleton>> SkeletonsOf(const LabelsReplies& replies);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SERVER_SUPPORT_RAW_CALL_H_
