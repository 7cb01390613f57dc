#ifndef BCCSKEL_SERVER_SERVICE_SKELETONIZE_STREAM_H_
#define BCCSKEL_SERVER_SERVICE_SKELETONIZE_STREAM_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "server/jobs/job_runner.h"
#include "server/service/request_sequence.h"
#include "server/service/response_outbox.h"

namespace bccskel::server {

// One Skeletonize call: hands requests to a job and the job's news to the caller. Nothing here
// computes or waits. At most one read, which is not begun before the job has taken in the chunk
// before, and at most one write are in flight.
//
// Reactions come on gRPC's threads, news on the job's; the mutex orders them. Start*() and Finish()
// are called with the mutex held: gRPC never reacts from inside such a call.
class SkeletonizeStream final
    : public grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>,
      public JobListener,
      public std::enable_shared_from_this<SkeletonizeStream> {
 public:
  // The stream owns itself until gRPC is done with it and the job has ended.
  // Needs: `context` and `runner` outlive the call.
  static SkeletonizeStream* Start(grpc::CallbackServerContext* context, JobRunner& runner,
                                  const VolumeLimits& limits);

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

  void OnBytesConsumed() override;
  void OnShell(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) override;
  void OnEnd(absl::StatusOr<JobResult> result) override;

 private:
  using Clock = exec::Context::Clock;

  SkeletonizeStream(JobRunner& runner, const VolumeLimits& limits, Clock::time_point deadline,
                    std::string trace);
  void Take(v1::SkeletonizeRequest& request);
  absl::Status StartJob(const v1::SkeletonizeConfig& config);
  void FinishVolume(const v1::VolumeFinish& finish);
  void ReadNext();
  // Ends the call with this error, unless it has one already, and cancels the job.
  void Fail(absl::Status status);
  // Writes the next response or finishes the call, if it is time. Needs: mutex_ held.
  void Advance();

  JobRunner& runner_;
  const VolumeLimits limits_;
  const Clock::time_point deadline_;
  const Clock::time_point started_ = Clock::now();
  const std::string trace_;  // the caller's traceparent, for the log
  std::shared_ptr<SkeletonizeStream> self_;

  // Used by read reactions only, and there is one at a time.
  v1::SkeletonizeRequest request_;
  RequestSequence sequence_;

  std::mutex mutex_;
  std::shared_ptr<Job> job_;                   // guarded by mutex_
  ResponseOutbox outbox_;                      // guarded by mutex_
  v1::SkeletonizeResponse response_;           // of the write in flight
  bool writing_ = false;                       // guarded by mutex_
  std::chrono::nanoseconds next_progress_{0};  // guarded by mutex_; since the computation began
  std::optional<absl::Status> error_;          // guarded by mutex_
  bool finished_ = false;                      // guarded by mutex_: Finish() was called
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_SKELETONIZE_STREAM_H_
