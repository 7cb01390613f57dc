#ifndef BCCSKEL_CLIENT_DURABLE_CLIENT_H_
#define BCCSKEL_CLIENT_DURABLE_CLIENT_H_

#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/durable_job.h"
#include "client/encoded_volume.h"
#include "client/endpoint.h"
#include "client/retry_loop.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::client {

// How much of a skeleton has been read, so that the next attempt resumes there.
class SkeletonReading;

// One attempt at each call about stored volumes, jobs and results.
// Threads: safe.
class DurableStub {
 public:
  using Limits = RetryLoop::Limits;
  using EventConsumer = std::function<void(const JobEvent&)>;
  virtual ~DurableStub() = default;

  // The volume's name on the server; empty if the server does not have it.
  virtual absl::StatusOr<std::string> FindVolume(const EncodedVolume& volume,
                                                 const Limits& limits) = 0;
  // Sends the bytes of the upload that the server lacks and returns the volume's name. Begun::kNo
  // saves the query for a new upload.
  enum class Begun { kMaybe, kNo };
  virtual absl::StatusOr<std::string> Upload(const std::string& upload, Begun begun,
                                             const EncodedVolume& volume, const Limits& limits) = 0;
  virtual absl::StatusOr<DurableJob> CreateJob(const NewJob& job, const Limits& limits) = 0;
  virtual absl::StatusOr<DurableJob> GetJob(const std::string& job, const Limits& limits) = 0;
  virtual absl::StatusOr<JobPage> ListJobs(int page_size, const std::string& page_token,
                                           const Limits& limits) = 0;
  virtual absl::StatusOr<DurableJob> CancelJob(const std::string& job, const Limits& limits) = 0;
  virtual absl::Status DeleteJob(const std::string& job, const Limits& limits) = 0;
  // OK after the event that reports the end of the job.
  virtual absl::Status WatchJob(const std::string& job, uint64_t after_sequence,
                                const EventConsumer& consume, const Limits& limits) = 0;
  // Resumes at the end of `reading`.
  virtual absl::Status ReadSkeleton(const std::string& job, SkeletonReading& reading,
                                    const Limits& limits) = 0;
};

// Jobs that outlive their caller and the server's process. Each call retries where that can help,
// and resumes where the last attempt broke off: an upload, a watch, a result.
//
//   DurableClient client(*MakeGrpcDurableStub({.address = "127.0.0.1:50051"}));
//   volume = client.Upload(encoded, calls);  job = client.CreateJob({.volume = *volume}, calls);
//   client.Watch(job->name, on_event, calls);  result = client.Fetch(job->name, calls);
//
// Errors of all calls: the server's, with its details as payloads; UNAVAILABLE when all attempts
//                      failed; CANCELLED; DEADLINE_EXCEEDED; DATA_LOSS for a damaged reply.
// Threads: safe; calls run concurrently.
class DurableClient {
 public:
  // Common options of all calls.
  struct Calls {
    std::chrono::milliseconds timeout = std::chrono::hours(1);  // for all attempts of a call
    std::stop_token stop = {};
  };

  explicit DurableClient(std::unique_ptr<DurableStub> stub, const RetryPolicy& policy = {},
                         Pause pause = PauseFor)
      : stub_(std::move(stub)), policy_(policy), pause_(std::move(pause)) {}

  // Sends the volume unless the server has it. Returns its name.
  absl::StatusOr<std::string> Upload(const EncodedVolume& volume, const Calls& calls);
  // Resumes the upload of this name, or starts it.
  absl::StatusOr<std::string> FinishUpload(const std::string& upload, const EncodedVolume& volume,
                                           const Calls& calls);
  absl::StatusOr<DurableJob> CreateJob(NewJob job, const Calls& calls);
  absl::StatusOr<DurableJob> GetJob(const std::string& job, const Calls& calls);
  absl::StatusOr<JobPage> ListJobs(int page_size, const std::string& page_token,
                                   const Calls& calls);
  absl::StatusOr<DurableJob> CancelJob(const std::string& job, const Calls& calls);
  absl::Status DeleteJob(const std::string& job, const Calls& calls);
  // Passes each event to `consume`, which may be empty, once; returns the job's final state.
  absl::StatusOr<JobState> Watch(const std::string& job, const DurableStub::EventConsumer& consume,
                                 const Calls& calls);
  // Waits for the job's end and passes each shell to `on_shell`, which may be empty.
  // Errors: also that of a job that failed; CANCELLED for a job that was cancelled.
  absl::Status Await(const std::string& job,
                     const std::function<void(const exec::ShellProgress&)>& on_shell,
                     const Calls& calls);
  // The result of a job that succeeded; with `thin` only if the job asked for it.
  absl::StatusOr<SkeletonizeResult> Fetch(const std::string& job, const Calls& calls);

 private:
  absl::StatusOr<std::string> Send(const std::string& upload, DurableStub::Begun begun,
                                   const EncodedVolume& volume, const Calls& calls);
  template <typename Attempt>
  auto Retry(const Calls& calls, Attempt attempt) -> decltype(attempt(DurableStub::Limits()));

  const std::unique_ptr<DurableStub> stub_;
  const RetryPolicy policy_;
  const Pause pause_;
};

// For stored jobs: retries for two minutes or more, long enough for a restart of the server.
inline constexpr RetryPolicy kOutlastRestart = {.max_attempts = 30};

// Over gRPC. Errors: as CheckEndpoint().
absl::StatusOr<std::unique_ptr<DurableStub>> MakeGrpcDurableStub(const Endpoint& endpoint);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_DURABLE_CLIENT_H_
