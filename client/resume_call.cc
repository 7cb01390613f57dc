#include "client/resume_call.h"

#include "core/exec/status_macros.h"

namespace bccskel::client {

absl::StatusOr<SkeletonizeResult> ResumeCall(DurableClient& client, const AcceptedCall& accepted,
                                             const EncodedVolume& volume,
                                             const CallOptions& options,
                                             std::chrono::milliseconds timeout) {
  const DurableClient::Calls calls = {.timeout = timeout, .stop = options.stop};
  BCCSKEL_RETURN_IF_ERROR(client.FinishUpload(accepted.upload, volume, calls).status());
  BCCSKEL_RETURN_IF_ERROR(client.Await(accepted.job, options.on_shell, calls));
  return client.Fetch(accepted.job, calls);
}

}  // namespace bccskel::client
