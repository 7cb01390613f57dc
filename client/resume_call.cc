#include "client/resume_call.h"

#include "core/exec/status_macros.h"

namespace bccskel::client {

absl::StatusOr<SkeletonizeResult> ResumeCall(DurableClient& client, const AcceptedCall& accepted,
                                             const EncodedVolume& volume,
                                             const CallOptions& options,
                                             std::chrono::milliseconds timeout) {
  const DurableClient::Calls calls = {.timeout = timeout, .stop = options.stop};
  BCCSKEL_RETURN_IF_ERROR(client.FinishUpload(accepted.upload, volume, calls).status());
  absl::Status error;
  const auto take = [&](const JobEvent& event) {
    if (event.shell.has_value() && options.on_shell) options.on_shell(*event.shell);
    if (event.state.has_value()) error = event.error;
  };
  BCCSKEL_ASSIGN_OR_RETURN(const JobState state, client.Watch(accepted.job, take, calls));
  if (state == JobState::kSucceeded) return client.Fetch(accepted.job, calls);
  return error.ok() ? absl::CancelledError("the job was cancelled") : error;
}

}  // namespace bccskel::client
