#ifndef BCCSKEL_CLIENT_CONNECTION_H_
#define BCCSKEL_CLIENT_CONNECTION_H_

#include <chrono>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/call_options.h"
#include "client/encoded_labels.h"
#include "client/encoded_volume.h"
#include "client/endpoint.h"
#include "client/retry_policy.h"
#include "core/labels/skeletonize_labels.h"

// The layers of the client: SkeletonizeClient -> Connection (retries) -> Stub (one attempt).
// Tests of programs that use the client replace the Connection, tests of the client the Stub.

namespace bccskel::client {

// The versions that a server reports.
struct ServerDescription {
  std::string server_version;
  std::string algorithm_version;
};

// Calls to a server, retried where that can help.
// Threads: safe.
class Connection {
 public:
  virtual ~Connection() = default;

  // Errors: the server's, with its details as payloads (see proto/wire/error_details.h);
  //         UNAVAILABLE when all attempts failed; CANCELLED; DEADLINE_EXCEEDED; DATA_LOSS when the
  //         reply is damaged, which includes a skeleton whose digest is not the stated one.
  virtual absl::StatusOr<SkeletonizeResult> Skeletonize(const EncodedVolume& volume,
                                                        const CallOptions& options) = 0;
  // Passes each label to `consume`, in ascending order, while the server computes the next ones;
  // the server waits for a slow consumer. An error of the consumer ends the call and becomes its
  // result.
  // Errors: as Skeletonize(). Does not retry after the first label, so that none is delivered
  //         twice.
  virtual absl::StatusOr<LabelsReport> SkeletonizeLabels(const EncodedLabels& volume,
                                                         const LabelsCallOptions& options,
                                                         const LabelConsumer& consume) = 0;
  virtual absl::StatusOr<ServerDescription> Describe(std::chrono::milliseconds timeout) = 0;
};

// One attempt at each call.
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

std::shared_ptr<Connection> MakeRetryingConnection(std::unique_ptr<Stub> stub,
                                                   const RetryPolicy& policy = {},
                                                   Pause pause = PauseFor);

// Over gRPC. Errors: as CheckEndpoint().
absl::StatusOr<std::unique_ptr<Stub>> MakeGrpcStub(const Endpoint& endpoint);

// Both of the above.
absl::StatusOr<std::shared_ptr<Connection>> Connect(const Endpoint& endpoint,
                                                    const RetryPolicy& policy = {});

// Without encryption and without a token. `address` is HOST:PORT or unix:PATH.
std::unique_ptr<Stub> MakeGrpcStub(const std::string& address);
std::shared_ptr<Connection> Connect(const std::string& address, const RetryPolicy& policy = {});

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_CONNECTION_H_
