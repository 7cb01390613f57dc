#ifndef BCCSKEL_SERVER_CALLS_MEMORY_SESSION_H_
#define BCCSKEL_SERVER_CALLS_MEMORY_SESSION_H_

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/exec/status_macros.h"
#include "proto/wire/labels.h"
#include "proto/wire/result.h"
#include "proto/wire/shell_points.h"
#include "server/calls/requests.h"
#include "server/calls/session.h"
#include "server/calls/skeleton_responses.h"
#include "server/errors/call_error.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/volume_receiver.h"

namespace bccskel::server {

// A job that lives in memory and ends with its call. The job reports to `Listener` and yields
// `Result`; `Responses` holds what is still to be sent.
template <typename Request, typename Response, typename Listener, typename Result,
          typename Responses>
class MemorySession : public Session<Request, Response>,
                      public Listener,
                      public std::enable_shared_from_this<
                          MemorySession<Request, Response, Listener, Result, Responses>> {
 public:
  using Call = typename Session<Request, Response>::Call;

  // Needs: `runner` outlives the session.
  MemorySession(std::shared_ptr<Call> call, JobRunner& runner, const VolumeLimits& limits)
      : call_(std::move(call)), runner_(runner), limits_(limits) {}

  absl::Status Begin(const typename Session<Request, Response>::Config& config) override {
    BCCSKEL_ASSIGN_OR_RETURN(auto request, JobRequestOf(config, limits_));
    request.deadline = call_->facts().deadline;
    request.origin.tenant = call_->facts().tenant;
    BCCSKEL_ASSIGN_OR_RETURN(std::shared_ptr<Job> job,
                             runner_.Start(std::move(request), this->shared_from_this()));
    call_->Accepted(job->name(), config.volume().size_bytes());
    std::unique_lock lock(mutex_);
    job_ = job;
    const std::optional<absl::Status> too_late = left_;
    lock.unlock();
    if (too_late.has_value()) job->EndWith(*too_late);
    Send([&] { responses_.Accept(job->name()); });
    call_->ReadNext();
    return absl::OkStatus();
  }
  void Append(v1::VolumeChunk& chunk) override {
    const absl::Status status = CheckChunk(chunk.data(), Crc32cOf(chunk));
    if (!status.ok()) return call_->EndWith(status);
    job_->Append(std::move(*chunk.mutable_data()));
  }
  void Finish(const v1::VolumeFinish& finish) override {
    job_->FinishVolume(DigestOf(finish));
    call_->ReadNext();  // to detect requests after the finish
  }

  std::optional<Response> Next() override { return responses_.Next(); }
  Following Follows(const Response&) const override {
    if (responses_.AtEnd()) return Following::kNothing;
    return responses_.HasMore() ? Following::kAtOnce : Following::kLater;
  }

  void Leave(const absl::Status& why) override {
    std::unique_lock lock(mutex_);
    left_ = why;
    const std::shared_ptr<Job> job = job_;
    lock.unlock();
    if (job != nullptr) job->EndWith(why);
  }
  // Releases the unsent responses: the job holds this session and may continue for a while.
  void Close() override {
    responses_ = Responses();
    std::shared_ptr<Job> job;
    const std::lock_guard lock(mutex_);
    job.swap(job_);
  }

  void OnBytesConsumed() override { call_->ReadNext(); }
  void OnEnd(absl::StatusOr<Result> result) override {
    if (!result.ok()) return call_->EndWith(WithJobReason(result.status()));
    Send([&] { responses_.Complete(*std::move(result)); });
  }

 protected:
  // Adds responses by `fill` and sends them.
  template <typename Fill>
  void Send(Fill fill) {
    call_->Change([&fill] {
      fill();
      return Sending::kNow;
    });
  }
  // Sends the newest progress immediately if kProgressInterval has passed since the last one or the
  // beginning, else with the next response. `elapsed` since the computation began.
  template <typename Progress>
  void Report(Progress progress, std::chrono::nanoseconds elapsed) {
    call_->Change([&] {
      responses_.Report(std::move(progress));
      if (elapsed < next_progress_) return Sending::kWithWhatFollows;
      next_progress_ = elapsed + kProgressInterval;
      return Sending::kNow;
    });
  }

  Responses responses_;  // guarded by the call's lock

 private:
  const std::shared_ptr<Call> call_;
  JobRunner& runner_;
  const VolumeLimits limits_;
  std::chrono::nanoseconds next_progress_ = kProgressInterval;  // guarded by the call's lock
  std::mutex mutex_;
  std::shared_ptr<Job> job_;          // set with mutex_ held, by Begin()
  std::optional<absl::Status> left_;  // guarded by mutex_
};

class SkeletonSession final : public MemorySession<v1::SkeletonizeRequest, v1::SkeletonizeResponse,
                                                   JobListener, JobResult, SkeletonResponses> {
 public:
  using MemorySession::MemorySession;

  void OnShell(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) override {
    Report(wire::ToMessage(progress, elapsed), elapsed);
  }
  uint64_t OnShellPoints(int32_t shell, const Volume& points) override {
    uint64_t bytes = 0;
    for (const v1::ShellPoints& message : wire::ShellPointsMessages(shell, points)) {
      std::string serialized = message.SerializeAsString();
      bytes += serialized.size();
      Send([&] { responses_.AddShellPoints(std::move(serialized)); });
    }
    return bytes;
  }
};

class LabelsSession final
    : public MemorySession<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse,
                           LabelsListener, LabelsResult, LabelResponses> {
 public:
  using MemorySession::MemorySession;

  void OnProgress(uint64_t done, uint64_t total, std::chrono::nanoseconds elapsed) override {
    Report(wire::ToMessage(wire::LabelProgress{.done = done, .total = total}, elapsed), elapsed);
  }
  void OnLabel(LabelResult result) override {
    Send([&] { responses_.Add(std::move(result)); });
  }
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_MEMORY_SESSION_H_
