#ifndef BCCSKEL_CLIENT_RESUME_CALL_H_
#define BCCSKEL_CLIENT_RESUME_CALL_H_

#include <chrono>
#include <string>

#include "absl/status/statusor.h"
#include "client/call_options.h"
#include "client/durable_client.h"
#include "client/encoded_volume.h"

namespace bccskel::client {

// The names that the server states when it accepts a durable Skeletonize call.
struct AcceptedCall {
  std::string upload;
  std::string job;
};

// Resumes a call after its stream has broken: sends the rest of the volume, waits for the job,
// reads the result. Nothing is computed twice.
// Errors: see DurableClient.
absl::StatusOr<SkeletonizeResult> ResumeCall(DurableClient& client, const AcceptedCall& accepted,
                                             const EncodedVolume& volume,
                                             const CallOptions& options,
                                             std::chrono::milliseconds timeout);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_RESUME_CALL_H_
