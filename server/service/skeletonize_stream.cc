#include "server/service/skeletonize_stream.h"

#include <algorithm>
#include <utility>

#include "core/exec/status_macros.h"
#include "proto/wire/result.h"
#include "server/logging/json_log.h"
#include "server/service/job_request.h"
#include "server/status_mapping.h"

namespace bccskel::server {
namespace {

using Clock = exec::Context::Clock;

// gRPC states deadlines in wall-clock time; jobs must not be moved by clock adjustments.
Clock::time_point SteadyDeadline(std::chrono::system_clock::time_point deadline) {
  const auto left = deadline - std::chrono::system_clock::now();
  constexpr auto kFar = std::chrono::hours(24 * 365);
  return left > kFar ? Clock::time_point::max() : Clock::now() + left;
}

std::string TraceOf(const grpc::CallbackServerContext& context) {
  const auto trace = context.client_metadata().find("traceparent");
  if (trace == context.client_metadata().end()) return std::string();
  return std::string(trace->second.data(), trace->second.size());
}

std::optional<Sha256Digest> DigestOf(const std::string& bytes) {
  Sha256Digest digest;
  if (bytes.size() != digest.bytes.size()) return std::nullopt;
  std::copy(bytes.begin(), bytes.end(), digest.bytes.begin());
  return digest;
}

// Every reply costs about 30 us on either side; a small object has dozens of shells in a
// millisecond. The newest shell is always sent.
constexpr std::chrono::milliseconds kProgressInterval(1);

// More follows a piece of the result at once, so gRPC may send them together.
grpc::WriteOptions WriteOptionsFor(const v1::SkeletonizeResponse& response) {
  grpc::WriteOptions options;
  if (response.has_skeleton_chunk() || response.has_thin_volume_chunk()) options.set_buffer_hint();
  return options;
}

}  // namespace

SkeletonizeStream* SkeletonizeStream::Start(grpc::CallbackServerContext* context, JobRunner& runner,
                                            const VolumeLimits& limits) {
  std::shared_ptr<SkeletonizeStream> stream(new SkeletonizeStream(
      runner, limits, SteadyDeadline(context->deadline()), TraceOf(*context)));
  stream->self_ = stream;
  stream->StartRead(&stream->request_);
  return stream.get();
}

SkeletonizeStream::SkeletonizeStream(JobRunner& runner, const VolumeLimits& limits,
                                     Clock::time_point deadline, std::string trace)
    : runner_(runner), limits_(limits), deadline_(deadline), trace_(std::move(trace)) {}

void SkeletonizeStream::OnReadDone(bool ok) {
  absl::Status status = ok ? sequence_.Take(request_) : sequence_.HalfClose();
  if (!status.ok()) return Fail(std::move(status));
  if (ok) Take(request_);
}

void SkeletonizeStream::Take(v1::SkeletonizeRequest& request) {
  if (request.has_config()) {
    if (absl::Status started = StartJob(request.config()); !started.ok()) {
      return Fail(std::move(started));
    }
    ReadNext();
  } else if (request.has_chunk()) {
    job_->Append(std::move(*request.mutable_chunk()->mutable_data()));
  } else {
    job_->FinishVolume(DigestOf(request.finish().sha256()));
    ReadNext();  // sees requests that must not come
  }
}

absl::Status SkeletonizeStream::StartJob(const v1::SkeletonizeConfig& config) {
  BCCSKEL_ASSIGN_OR_RETURN(JobRequest request, JobRequestOf(config, limits_));
  request.deadline = deadline_;
  BCCSKEL_ASSIGN_OR_RETURN(std::shared_ptr<Job> job,
                           runner_.Start(std::move(request), shared_from_this()));
  Log(LogLevel::kInfo, "job accepted",
      {{"job", job->name()},
       {"volume_bytes", static_cast<int64_t>(config.volume().size_bytes())},
       {"traceparent", trace_}});
  std::unique_lock lock(mutex_);
  job_ = job;
  outbox_.Accept(job->name());
  Advance();
  const bool too_late = error_.has_value();
  lock.unlock();
  if (too_late) job->Cancel();
  return absl::OkStatus();
}

void SkeletonizeStream::ReadNext() {
  std::lock_guard lock(mutex_);
  if (!finished_) StartRead(&request_);
}

void SkeletonizeStream::OnWriteDone(bool ok) {
  {
    std::lock_guard lock(mutex_);
    writing_ = false;
    // A call that has failed while it wrote waits for this moment to finish.
    if (ok || error_.has_value()) return Advance();
  }
  Fail(absl::CancelledError("the caller is gone"));
}

void SkeletonizeStream::OnCancel() {
  Fail(Clock::now() >= deadline_ ? absl::DeadlineExceededError("the call's deadline has passed")
                                 : absl::CancelledError("the caller cancelled the call"));
}

void SkeletonizeStream::OnBytesConsumed() { ReadNext(); }

void SkeletonizeStream::OnShell(const exec::ShellProgress& progress,
                                std::chrono::nanoseconds elapsed) {
  std::lock_guard lock(mutex_);
  outbox_.Report(wire::ToMessage(progress, elapsed));
  if (elapsed < next_progress_) return;  // goes with whatever comes next
  next_progress_ = elapsed + kProgressInterval;
  Advance();
}

void SkeletonizeStream::OnEnd(absl::StatusOr<JobResult> result) {
  if (!result.ok()) return Fail(result.status());
  std::lock_guard lock(mutex_);
  if (error_.has_value()) return;
  outbox_.Complete(*std::move(result));
  Advance();
}

void SkeletonizeStream::Fail(absl::Status status) {
  std::shared_ptr<Job> job;
  {
    std::lock_guard lock(mutex_);
    if (finished_ || error_.has_value()) return;
    error_ = std::move(status);
    job = job_;
    Advance();
  }
  if (job != nullptr) job->Cancel();
}

void SkeletonizeStream::Advance() {
  if (finished_ || writing_) return;
  if (error_.has_value()) {
    finished_ = true;
    return Finish(ToGrpcStatus(*error_));
  }
  auto response = outbox_.Next();
  if (!response.has_value()) return;
  response_ = *std::move(response);
  writing_ = true;
  if (outbox_.AtEnd()) {
    finished_ = true;
    return StartWriteAndFinish(&response_, grpc::WriteOptions(), grpc::Status::OK);
  }
  StartWrite(&response_, WriteOptionsFor(response_));
}

void SkeletonizeStream::OnDone() {
  std::shared_ptr<SkeletonizeStream> self = std::move(self_);
  std::lock_guard lock(mutex_);
  const absl::Status status = error_.value_or(absl::OkStatus());
  Log(status.ok() ? LogLevel::kInfo : LogLevel::kWarning, "call ended",
      {{"job", job_ == nullptr ? std::string() : job_->name()},
       {"code", absl::StatusCodeToString(status.code())},
       {"message", std::string(status.message())},
       {"seconds", std::chrono::duration<double>(Clock::now() - started_).count()},
       {"traceparent", trace_}});
  job_.reset();
  outbox_ = ResponseOutbox();
}

}  // namespace bccskel::server
