#ifndef BCCSKEL_CLIENT_SKELETONIZE_CLIENT_H_
#define BCCSKEL_CLIENT_SKELETONIZE_CLIENT_H_

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "client/call_options.h"
#include "client/encoded_labels.h"
#include "client/encoded_volume.h"
#include "client/endpoint.h"
#include "client/retry_policy.h"
#include "core/labels/skeletonize_labels.h"
#include "core/volume/volume.h"

namespace bccskel::client {

// The versions that a server reports.
struct ServerDescription {
  std::string server_version;
  std::string algorithm_version;
};

// One attempt at each call. Tests replace it.
// Threads: safe.
class Stub {
 public:
  using Clock = std::chrono::system_clock;
  virtual ~Stub() = default;

  virtual absl::StatusOr<SkeletonizeResult> Skeletonize(const EncodedVolume& volume,
                                                        const CallOptions& options,
                                                        Clock::time_point deadline) = 0;
  virtual absl::StatusOr<LabelsReport> SkeletonizeLabels(const EncodedLabels& volume,
                                                         const LabelsCallOptions& options,
                                                         const LabelConsumer& consume,
                                                         Clock::time_point deadline) = 0;
  virtual absl::StatusOr<ServerDescription> Describe(Clock::time_point deadline) = 0;
};

// Over gRPC. Errors: as CheckEndpoint().
absl::StatusOr<std::unique_ptr<Stub>> MakeGrpcStub(const Endpoint& endpoint);
// Without encryption and without a token. `address` is HOST:PORT or unix:PATH.
std::unique_ptr<Stub> MakeGrpcStub(const std::string& address);

// Skeletons from a server. Each call retries where that can help.
//
//   using namespace bccskel::client;
//   SkeletonizeClient client(MakeGrpcStub("127.0.0.1:50051"));
//   absl::StatusOr<bccskel::SkeletonizeResult> result = client.Skeletonize(volume, {});
//
// Errors of all calls: the server's, with its details as payloads (see proto/wire/error_details.h);
//                      UNAVAILABLE when all attempts failed; CANCELLED; DEADLINE_EXCEEDED;
//                      DATA_LOSS when the reply is damaged, which includes a skeleton whose digest
//                      is not the stated one.
// Threads: safe; calls run concurrently.
class SkeletonizeClient {
 public:
  explicit SkeletonizeClient(std::unique_ptr<Stub> stub, const RetryPolicy& policy = {},
                             Pause pause = PauseFor)
      : stub_(std::move(stub)), policy_(policy), pause_(std::move(pause)) {}

  // The same result as core/pipeline on this machine; `thin` only if the options request it.
  absl::StatusOr<SkeletonizeResult> Skeletonize(const Volume& object, const CallOptions& options);

  // The skeleton of every label of a segmented image, as from core/labels on this machine (without
  // `thin`). Passes each to `consume`, in ascending order, while the server computes the next ones;
  // the server waits for a slow consumer. An error of the consumer ends the call and becomes its
  // result. Does not retry after the first label, so that none is delivered twice.
  // Errors: also INVALID_ARGUMENT (volume).
  absl::StatusOr<LabelsReport> SkeletonizeLabels(const LabelVolume& volume,
                                                 const LabelsCallOptions& options,
                                                 const LabelConsumer& consume);

  absl::StatusOr<ServerDescription> Describe(std::chrono::milliseconds timeout);

 private:
  const std::unique_ptr<Stub> stub_;
  const RetryPolicy policy_;
  const Pause pause_;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_SKELETONIZE_CLIENT_H_
