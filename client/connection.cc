#include "client/connection.h"

#include <utility>

#include "client/retry_loop.h"
#include "core/exec/status_macros.h"

namespace bccskel::client {
namespace {

using std::chrono::milliseconds;

class RetryingConnection : public Connection {
 public:
  RetryingConnection(std::unique_ptr<Stub> stub, const RetryPolicy& policy, Pause pause)
      : stub_(std::move(stub)), policy_(policy), pause_(std::move(pause)) {}

  absl::StatusOr<SkeletonizeResult> Skeletonize(const EncodedVolume& volume,
                                                const CallOptions& options) override {
    return RetryLoop(policy_, pause_, options.timeout, options.stop).Run([&](auto deadline) {
      return stub_->Skeletonize(volume, options, deadline);
    });
  }

  absl::StatusOr<LabelsReport> SkeletonizeLabels(const EncodedLabels& volume,
                                                 const LabelsCallOptions& options,
                                                 const LabelConsumer& consume) override {
    bool delivered = false;
    const LabelConsumer consume_once = [&](LabelSkeleton&& skeleton) {
      delivered = true;
      return consume(std::move(skeleton));
    };
    RetryLoop loop(policy_, pause_, options.timeout, options.stop);
    return loop.Run([&](auto deadline) {
      auto report = stub_->SkeletonizeLabels(volume, options, consume_once, deadline);
      if (delivered) loop.Stop();
      return report;
    });
  }

  absl::StatusOr<ServerDescription> Describe(milliseconds timeout) override {
    return RetryLoop(policy_, pause_, timeout, {}).Run([&](auto deadline) {
      return stub_->Describe(deadline);
    });
  }

 private:
  std::unique_ptr<Stub> stub_;
  RetryPolicy policy_;
  Pause pause_;
};

}  // namespace

std::shared_ptr<Connection> MakeRetryingConnection(std::unique_ptr<Stub> stub,
                                                   const RetryPolicy& policy, Pause pause) {
  return std::make_shared<RetryingConnection>(std::move(stub), policy, std::move(pause));
}

absl::StatusOr<std::shared_ptr<Connection>> Connect(const Endpoint& endpoint,
                                                    const RetryPolicy& policy) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<Stub> stub, MakeGrpcStub(endpoint));
  return MakeRetryingConnection(std::move(stub), policy);
}

std::shared_ptr<Connection> Connect(const std::string& address, const RetryPolicy& policy) {
  return MakeRetryingConnection(MakeGrpcStub(address), policy);
}

}  // namespace bccskel::client
