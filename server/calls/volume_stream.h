#ifndef BCCSKEL_SERVER_CALLS_VOLUME_STREAM_H_
#define BCCSKEL_SERVER_CALLS_VOLUME_STREAM_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "core/exec/status_macros.h"
#include "server/jobs/job_runner.h"
#include "server/calls/call_gate.h"
#include "server/calls/refused_call.h"
#include "server/calls/request_sequence.h"
#include "server/calls/sender_clock.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

// One call that uploads a volume: hands requests to a job and the job's news to the caller. Nothing
// here computes or waits. At most one read, which is not begun before the job has taken in the
// chunk before, and at most one write are in flight.
//
// Reactions come on gRPC's threads, news on the job's; the mutex orders them. Start*() and Finish()
// are called with the mutex held: gRPC never reacts from inside such a call.
//
// `Call` names what differs between the kinds of call:
//   Request, Response   messages; a request is one of config, chunk and finish
//   Listener, Result    what a job of this kind tells
//   Outbox              what is still to be sent
//   JobRequestOf()      reads the config
template <typename Call>
class VolumeStream
    : public grpc::ServerBidiReactor<typename Call::Request, typename Call::Response>,
      public Call::Listener,
      public LastingCall,
      public std::enable_shared_from_this<VolumeStream<Call>> {
 public:
  using Request = typename Call::Request;
  using Response = typename Call::Response;
  using Result = typename Call::Result;

  // Needs: `runner` outlives the call.
  VolumeStream(CallFacts facts, JobRunner& runner, const VolumeLimits& limits)
      : runner_(runner), limits_(limits), facts_(std::move(facts)) {}

  // From here on the stream owns itself, until gRPC is done with it and the job has ended.
  void Begin() {
    self_ = this->shared_from_this();
    sender_.Await(Clock::now());
    this->StartRead(&request_);
    facts_.LookAfter(self_);
  }

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

  void EndEarly(const absl::Status& why) override { Fail(why); }
  absl::Status CheckSender(TimePoint now, std::chrono::milliseconds limit) override {
    std::lock_guard lock(mutex_);
    return sender_.Check(now, limit);
  }

  void OnBytesConsumed() override { ReadNext(); }
  void OnEnd(absl::StatusOr<Result> result) override;

 protected:
  // The newest progress goes out, or, within kProgressInterval of the one before or the beginning,
  // with what comes next.
  // `elapsed` since the computation began.
  template <typename Progress>
  void Report(Progress progress, std::chrono::nanoseconds elapsed);

  // Puts something into the outbox and sees that it is sent.
  template <typename Fill>
  void Send(Fill fill) {
    std::lock_guard lock(mutex_);
    if (error_.has_value()) return;
    fill(outbox_);
    Advance();
  }

  const Request& request() const { return request_; }
  const VolumeLimits& limits() const { return limits_; }
  const CallFacts& facts() const { return facts_; }
  // What keeps the stream alive. Needs: gRPC is done with it.
  std::shared_ptr<VolumeStream> LetGo() {
    facts_.Leave(*this);
    return std::move(self_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void Take(Request& request);
  void HalfClose();
  absl::Status StartJob(const Request& request);
  void ReadNext();
  // Ends the call with this error, unless it has one already, and cancels the job.
  void Fail(absl::Status status);
  // Writes the next response or finishes the call, if it is time. Needs: mutex_ held.
  void Advance();

  // Every reply costs about 30 us on either side; a small object has dozens of shells in a
  // millisecond. The newest progress is always sent.
  static constexpr std::chrono::milliseconds kProgressInterval{1};

  JobRunner& runner_;
  const VolumeLimits limits_;
  const CallFacts facts_;
  std::shared_ptr<VolumeStream> self_;

  // Used by read reactions only, and there is one at a time.
  Request request_;
  RequestSequence sequence_;

  std::mutex mutex_;
  SenderClock sender_;            // guarded by mutex_
  std::shared_ptr<Job> job_;      // guarded by mutex_
  typename Call::Outbox outbox_;  // guarded by mutex_
  Response response_;             // of the write in flight
  bool writing_ = false;          // guarded by mutex_
  // Since the computation began; guarded by mutex_.
  std::chrono::nanoseconds next_progress_ = kProgressInterval;
  std::optional<absl::Status> error_;  // guarded by mutex_
  bool half_closed_ = false;           // guarded by mutex_: before the finish
  bool finished_ = false;              // guarded by mutex_: Finish() was called
};

template <typename Call>
void VolumeStream<Call>::OnReadDone(bool ok) {
  if (!ok) return HalfClose();
  {
    std::lock_guard lock(mutex_);
    sender_.Take(Clock::now(), request_.has_chunk() ? request_.chunk().data().size() : 0);
  }
  absl::Status status = sequence_.Take(request_);
  if (!status.ok()) return Fail(std::move(status));
  Take(request_);
}

template <typename Call>
void VolumeStream<Call>::HalfClose() {
  absl::Status status = sequence_.HalfClose();
  if (status.ok()) return;
  {
    std::lock_guard lock(mutex_);
    half_closed_ = true;
  }
  Fail(std::move(status));
}

template <typename Call>
void VolumeStream<Call>::OnCancel() {
  const absl::Status status = facts_.CancelStatus();
  {
    std::lock_guard lock(mutex_);
    // A connection that breaks looks like a half-close at first.
    if (half_closed_ && error_.has_value()) error_ = status;
  }
  Fail(status);
}

template <typename Call>
void VolumeStream<Call>::Take(Request& request) {
  if (request.has_config()) {
    if (absl::Status started = StartJob(request); !started.ok()) return Fail(std::move(started));
    ReadNext();
  } else if (request.has_chunk()) {
    job_->Append(std::move(*request.mutable_chunk()->mutable_data()));
  } else {
    job_->FinishVolume(DigestOf(request.finish()));
    ReadNext();  // sees requests that must not come
  }
}

template <typename Call>
absl::Status VolumeStream<Call>::StartJob(const Request& request) {
  BCCSKEL_ASSIGN_OR_RETURN(auto job_request, Call::JobRequestOf(request.config(), limits_));
  job_request.deadline = facts_.deadline;
  job_request.origin.tenant = facts_.tenant;
  BCCSKEL_ASSIGN_OR_RETURN(std::shared_ptr<Job> job,
                           runner_.Start(std::move(job_request), this->shared_from_this()));
  facts_.LogAccepted(job->name(), request.config().volume().size_bytes());
  std::unique_lock lock(mutex_);
  job_ = job;
  outbox_.Accept(job->name());
  Advance();
  const std::optional<absl::Status> too_late = error_;
  lock.unlock();
  if (too_late.has_value()) job->EndWith(*too_late);
  return absl::OkStatus();
}

template <typename Call>
void VolumeStream<Call>::ReadNext() {
  std::lock_guard lock(mutex_);
  if (finished_) return;
  if (!sequence_.finished()) sender_.Await(Clock::now());
  this->StartRead(&request_);
}

template <typename Call>
void VolumeStream<Call>::OnWriteDone(bool ok) {
  {
    std::lock_guard lock(mutex_);
    writing_ = false;
    // A call that has failed while it wrote waits for this moment to finish.
    if (ok || error_.has_value()) return Advance();
  }
  Fail(absl::CancelledError("the caller is gone"));
}

template <typename Call>
template <typename Progress>
void VolumeStream<Call>::Report(Progress progress, std::chrono::nanoseconds elapsed) {
  std::lock_guard lock(mutex_);
  outbox_.Report(std::move(progress));
  if (elapsed < next_progress_) return;  // goes with whatever comes next
  next_progress_ = elapsed + kProgressInterval;
  Advance();
}

template <typename Call>
void VolumeStream<Call>::OnEnd(absl::StatusOr<Result> result) {
  if (!result.ok()) return Fail(WithJobReason(result.status()));
  Send([&](auto& outbox) { outbox.Complete(*std::move(result)); });
}

template <typename Call>
void VolumeStream<Call>::Fail(absl::Status status) {
  std::shared_ptr<Job> job;
  {
    std::lock_guard lock(mutex_);
    if (finished_ || error_.has_value()) return;
    error_ = status;
    if (!half_closed_) job = job_;  // else OnDone() knows whether it was one
    Advance();
  }
  if (job != nullptr) job->EndWith(std::move(status));
}

template <typename Call>
void VolumeStream<Call>::Advance() {
  if (finished_ || writing_) return;
  if (error_.has_value()) {
    finished_ = true;
    return this->Finish(ToGrpcStatus(*error_));
  }
  auto response = outbox_.Next();
  if (!response.has_value()) return;
  response_ = *std::move(response);
  writing_ = true;
  if (outbox_.AtEnd()) {
    finished_ = true;
    return this->StartWriteAndFinish(&response_, grpc::WriteOptions(), grpc::Status::OK);
  }
  grpc::WriteOptions options;
  // What follows at once goes with it in one write to the socket.
  if (outbox_.HasMore()) options.set_buffer_hint();
  this->StartWrite(&response_, options);
}

template <typename Call>
void VolumeStream<Call>::OnDone() {
  const std::shared_ptr<VolumeStream> self = LetGo();
  std::unique_lock lock(mutex_);
  facts_.LogEnded(job_ == nullptr ? std::string() : job_->name(),
                  error_.value_or(absl::OkStatus()));
  const std::shared_ptr<Job> job = std::move(job_);
  const absl::Status error = half_closed_ ? error_.value_or(absl::OkStatus()) : absl::OkStatus();
  outbox_ = typename Call::Outbox();
  lock.unlock();
  if (job != nullptr && !error.ok()) job->EndWith(error);
}

// Starts a call's handler. Needs: `runner`, and what `more` refers to, outlive the call.
template <typename Stream, typename... More>
grpc::ServerBidiReactor<typename Stream::Request, typename Stream::Response>* StartStream(
    absl::StatusOr<CallFacts> facts, JobRunner& runner, const VolumeLimits& limits, More&... more) {
  if (!facts.ok()) {
    return new RefusedCall<
        grpc::ServerBidiReactor<typename Stream::Request, typename Stream::Response>>(
        facts.status());
  }
  const auto stream = std::make_shared<Stream>(*std::move(facts), runner, limits, more...);
  stream->Begin();
  return stream.get();
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_VOLUME_STREAM_H_
