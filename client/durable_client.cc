#include "client/durable_client.h"

#include <utility>

#include "client/skeleton_reading.h"
#include "core/digest/random_id.h"
#include "core/exec/status_macros.h"

namespace bccskel::client {

const char* NameOf(JobState state) {
  switch (state) {
    case JobState::kUnknown:
      return "unknown";
    case JobState::kReceiving:
      return "receiving";
    case JobState::kQueued:
      return "queued";
    case JobState::kRunning:
      return "running";
    case JobState::kSucceeded:
      return "succeeded";
    case JobState::kFailed:
      return "failed";
    case JobState::kCancelled:
      return "cancelled";
  }
  return "unknown";  // not reached: the enumerators are exhausted above
}

template <typename Attempt>
auto DurableClient::Retry(const Calls& calls, Attempt attempt)
    -> decltype(attempt(DurableStub::Limits())) {
  return RetryLoop(policy_, pause_, calls.timeout, calls.stop).Run(std::move(attempt));
}

absl::StatusOr<std::string> DurableClient::Upload(const EncodedVolume& volume, const Calls& calls) {
  absl::StatusOr<std::string> found =
      Retry(calls, [&](const auto& limits) { return stub_->FindVolume(volume, limits); });
  if (!found.ok() || !found->empty()) return found;
  return Send("uploads/" + RandomId(), DurableStub::Begun::kNo, volume, calls);
}

absl::StatusOr<std::string> DurableClient::FinishUpload(const std::string& upload,
                                                        const EncodedVolume& volume,
                                                        const Calls& calls) {
  return Send(upload, DurableStub::Begun::kMaybe, volume, calls);
}

absl::StatusOr<std::string> DurableClient::Send(const std::string& upload, DurableStub::Begun begun,
                                                const EncodedVolume& volume, const Calls& calls) {
  return Retry(calls, [&](const auto& limits) -> absl::StatusOr<std::string> {
    const auto known = std::exchange(begun, DurableStub::Begun::kMaybe);
    absl::StatusOr<std::string> sent = stub_->Upload(upload, known, volume, limits);
    if (!absl::IsOutOfRange(sent.status())) return sent;
    // The server has a different number of bytes than it reported: those of a broken stream arrived
    // late.
    return absl::UnavailableError(sent.status().message());
  });
}

absl::StatusOr<DurableJob> DurableClient::CreateJob(NewJob job, const Calls& calls) {
  // So that a retry does not create a second job.
  if (job.request_id.empty()) job.request_id = RandomId();
  return Retry(calls, [&](const auto& limits) { return stub_->CreateJob(job, limits); });
}

absl::StatusOr<DurableJob> DurableClient::GetJob(const std::string& job, const Calls& calls) {
  return Retry(calls, [&](const auto& limits) { return stub_->GetJob(job, limits); });
}

absl::StatusOr<JobPage> DurableClient::ListJobs(int page_size, const std::string& page_token,
                                                const Calls& calls) {
  return Retry(calls,
               [&](const auto& limits) { return stub_->ListJobs(page_size, page_token, limits); });
}

absl::StatusOr<DurableJob> DurableClient::CancelJob(const std::string& job, const Calls& calls) {
  return Retry(calls, [&](const auto& limits) { return stub_->CancelJob(job, limits); });
}

absl::Status DurableClient::DeleteJob(const std::string& job, const Calls& calls) {
  return Retry(calls, [&](const auto& limits) { return stub_->DeleteJob(job, limits); });
}

absl::StatusOr<JobState> DurableClient::Watch(const std::string& job,
                                              const DurableStub::EventConsumer& consume,
                                              const Calls& calls) {
  RetryLoop loop(policy_, pause_, calls.timeout, calls.stop);
  uint64_t known = 0;
  JobState state = JobState::kUnknown;
  const auto take = [&](const JobEvent& event) {
    known = event.sequence;
    state = event.state.value_or(state);
    loop.Progressed();
    if (consume) consume(event);
  };
  BCCSKEL_RETURN_IF_ERROR(
      loop.Run([&](const auto& limits) { return stub_->WatchJob(job, known, take, limits); }));
  if (HasEnded(state)) return state;
  return absl::DataLossError("the watch ended before " + job + " did");
}

absl::Status DurableClient::Await(const std::string& job,
                                  const std::function<void(const exec::ShellProgress&)>& on_shell,
                                  const Calls& calls) {
  absl::Status error;
  const auto take = [&](const JobEvent& event) {
    if (event.shell.has_value() && on_shell) on_shell(*event.shell);
    if (event.state.has_value()) error = event.error;
  };
  BCCSKEL_ASSIGN_OR_RETURN(const JobState state, Watch(job, take, calls));
  if (state == JobState::kSucceeded) return absl::OkStatus();
  if (!error.ok()) return error;
  return state == JobState::kCancelled ? absl::CancelledError("the job was cancelled")
                                       : absl::InternalError("the job failed");
}

absl::StatusOr<SkeletonizeResult> DurableClient::Fetch(const std::string& job, const Calls& calls) {
  RetryLoop loop(policy_, pause_, calls.timeout, calls.stop);
  SkeletonReading reading;
  BCCSKEL_RETURN_IF_ERROR(loop.Run([&](const auto& limits) {
    const uint32_t before = reading.pieces();
    absl::Status status = stub_->ReadSkeleton(job, reading, limits);
    if (reading.pieces() > before) loop.Progressed();
    return status;
  }));
  return std::move(reading).Finish();
}

}  // namespace bccskel::client
