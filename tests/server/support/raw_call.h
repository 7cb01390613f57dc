#ifndef BCCSKEL_TESTS_SERVER_SUPPORT_RAW_CALL_H_
#define BCCSKEL_TESTS_SERVER_SUPPORT_RAW_CALL_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::test {

// One Skeletonize call, taken step by step, with nothing of the client library in between.
class RawCall {
 public:
  explicit RawCall(const std::shared_ptr<grpc::Channel>& channel,
                   std::chrono::milliseconds timeout = std::chrono::minutes(2));

  // False when the call has ended.
  bool Send(const v1::SkeletonizeRequest& request) { return stream_->Write(request); }
  void CloseSending() { stream_->WritesDone(); }
  // Nothing when the call has ended.
  std::optional<v1::SkeletonizeResponse> Receive();
  void Cancel() { context_.TryCancel(); }
  // Reads what is left and says how the call ended, with the details as payloads.
  absl::Status Finish();

 private:
  grpc::ClientContext context_;
  std::unique_ptr<v1::SkeletonizationService::Stub> stub_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::SkeletonizeRequest, v1::SkeletonizeResponse>>
      stream_;
};

// A whole conversation.
struct Replies {
  std::vector<v1::SkeletonizeResponse> responses;
  absl::Status status;
};
Replies Converse(const std::shared_ptr<grpc::Channel>& channel,
                 const std::vector<v1::SkeletonizeRequest>& requests);

// The skeleton that the replies make, checked as clients check it; `thin` stays empty.
absl::StatusOr<SkeletonizeResult> SkeletonOf(const Replies& replies);
// The bytes of the thinned volume.
std::string ThinVolumeOf(const Replies& replies);

absl::Status FromGrpcStatus(const grpc::Status& status);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SERVER_SUPPORT_RAW_CALL_H_
