#ifndef BCCSKEL_SERVER_CALLS_STREAM_CALL_H_
#define BCCSKEL_SERVER_CALLS_STREAM_CALL_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/calls/call_gate.h"
#include "server/calls/request_sequence.h"
#include "server/calls/sender_clock.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

// The base of all streaming calls: how they begin, fail and end. A call owns itself from Open()
// until gRPC is done with it. `Reactor` is one of grpc::Server*Reactor.
//
// Reactions run on gRPC's threads, news of jobs on those of the jobs; the mutex orders them.
// Start*() and Finish() are called with the mutex held, because gRPC never reacts from inside such
// a call.
template <typename Reactor>
class StreamCall : public Reactor,
                   public OpenStream,
                   public std::enable_shared_from_this<StreamCall<Reactor>> {
 public:
  using ReactorType = Reactor;

  explicit StreamCall(CallFacts facts) : facts_(std::move(facts)) {}

  void EndEarly(const absl::Status& why) override { End(why); }
  void OnCancel() override {
    const absl::Status status = facts_.CancelStatus();
    {
      std::lock_guard lock(mutex_);
      // A broken connection looks like a half-close at first.
      if (half_closed_ && end_.has_value()) end_ = status;
    }
    End(status);
  }
  void OnDone() override {
    const std::shared_ptr<StreamCall> self = std::move(self_);
    facts_.gate->open_streams().Remove(*this);
    std::unique_lock lock(mutex_);
    done_ = true;
    const absl::Status end = end_.value_or(absl::OkStatus());
    facts_.LogEnded(subject_, end);
    const bool failed_late = half_closed_ && !end.ok();
    lock.unlock();
    if (failed_late) Failed(end);
    Closed();
  }

 protected:
  void Open() {
    self_ = this->shared_from_this();
    facts_.gate->open_streams().Add(self_, facts_);
  }
  // Ends the call with this status unless it is ending already.
  void End(const absl::Status& status) {
    {
      std::lock_guard lock(mutex_);
      if (finished_ || end_.has_value()) return;
      end_ = status;
      Advance();
      if (half_closed_) return;  // OnDone() knows whether it was a half-close
    }
    if (!status.ok()) Failed(status);
  }
  // Takes the next step that is possible, such as finishing the call. Needs: mutex_ held.
  virtual void Advance() {
    if (finished_ || !end_.has_value()) return;
    finished_ = true;
    this->Finish(ToGrpcStatus(*end_));
  }
  // The call has failed: its work is no longer needed.
  virtual void Failed(const absl::Status&) {}
  // gRPC is done with the call.
  virtual void Closed() {}

  const CallFacts facts_;
  std::mutex mutex_;
  std::string subject_;              // guarded by mutex_: as in CallFacts::LogEnded()
  std::optional<absl::Status> end_;  // guarded by mutex_
  bool half_closed_ = false;         // guarded by mutex_: reads ended before the finish
  bool finished_ = false;            // guarded by mutex_: nothing more may be started
  bool done_ = false;                // guarded by mutex_: by gRPC

 private:
  std::shared_ptr<StreamCall> self_;
};

// What follows a response: nothing, the call ends; a response that is ready; one that Fetch()
// brings, soon or later; or it is not known yet.
enum class Following { kNothing, kAtOnce, kFetchedAtOnce, kFetched, kLater };

// A call that writes the responses that Next() yields, one at a time.
template <typename Base, typename Response>
class WritingCall : public Base {
 public:
  using Base::Base;

  // A caller who reads receives `why`. A write that nobody reads is cancelled when this is called
  // again, as CheckCaller() ensures, or if it is the last one; until then it keeps its memory.
  void EndEarly(const absl::Status& why) override {
    {
      std::lock_guard lock(this->mutex_);
      if (this->done_) return;
      if (writing() && (this->finished_ || ended_early_)) {
        this->end_ = why;
        return this->facts_.context->TryCancel();
      }
      ended_early_ = true;
    }
    Base::EndEarly(why);
  }
  absl::Status CheckCaller(OpenStream::TimePoint now, const CallerTimeouts& timeouts) override {
    std::lock_guard lock(this->mutex_);
    if (ended_early_ && writing() && this->end_.has_value()) return *this->end_;
    const bool waits = timeouts.reader.count() > 0 && writing();
    if (!waits || now - *writing_since_ <= timeouts.reader) return absl::OkStatus();
    const std::string ms = absl::StrCat(timeouts.reader.count());
    return CallError(Reason::kReaderTimeout,
                     absl::StrCat("the caller has read nothing for more than ", ms,
                                  " ms (reader-timeout-ms) while a response waited"),
                     {.key = "reader_timeout_ms", .value = ms});
  }
  void OnWriteDone(bool ok) override {
    bool fetch = false;
    {
      std::lock_guard lock(this->mutex_);
      writing_since_.reset();
      const Following following = Follows(response_);
      fetch = ok && !this->end_.has_value() &&
              (following == Following::kFetched || following == Following::kFetchedAtOnce);
      // A call that failed during a write finishes only now.
      if (ok || this->end_.has_value()) Advance();
    }
    if (!ok) return this->End(absl::CancelledError("the caller is gone"));
    if (fetch) Fetch();
  }

 protected:
  // The next response, if there is one now. Needs of both: mutex_ held.
  virtual std::optional<Response> Next() = 0;
  virtual Following Follows(const Response&) const { return Following::kLater; }
  // Called after the write of a response for which Follows() said kFetched or kFetchedAtOnce.
  virtual void Fetch() {}

  void Advance() override {
    if (this->finished_ || writing()) return;
    const bool failed = this->end_.has_value() && !this->end_->ok();
    std::optional<Response> response = failed ? std::nullopt : Next();
    if (!response.has_value()) return Base::Advance();
    response_ = *std::move(response);
    writing_since_ = std::chrono::steady_clock::now();
    grpc::WriteOptions options;
    const Following following = Follows(response_);
    if (following == Following::kNothing) {
      this->finished_ = true;
      return this->StartWriteAndFinish(&response_, options, grpc::Status::OK);
    }
    // Combines this response with the next in one write to the socket. Not the first: gRPC 1.51
    // sends it with the initial metadata, and with the hint never reports them as written.
    if (begun_ && (following == Following::kAtOnce || following == Following::kFetchedAtOnce)) {
      options.set_buffer_hint();
    }
    begun_ = true;
    this->StartWrite(&response_, options);
  }
  bool writing() const { return writing_since_.has_value(); }  // Needs: mutex_ held.

 private:
  Response response_;                                   // of the write in flight
  std::optional<OpenStream::TimePoint> writing_since_;  // guarded by mutex_
  bool begun_ = false;                                  // guarded by mutex_: has written
  bool ended_early_ = false;                            // guarded by mutex_
};

// A call that reads a config, the chunks of a volume and a finish. Read() begins the next read;
// call it when the server can take more.
template <typename Base, typename Request>
class ReceivingCall : public Base {
 public:
  using Base::Base;

  void OnReadDone(bool ok) override {
    if (!ok) return HalfClose();
    {
      std::lock_guard lock(this->mutex_);
      sender_.Take(Clock::now(), request_.has_chunk() ? request_.chunk().data().size() : 0);
    }
    absl::Status status = CheckWanted(request_);
    if (status.ok()) status = sequence_.Take(request_);
    if (status.ok()) status = Take(request_);
    if (!status.ok()) this->End(status);
  }
  absl::Status CheckCaller(OpenStream::TimePoint now, const CallerTimeouts& timeouts) override {
    std::unique_lock lock(this->mutex_);
    const absl::Status sender = sender_.Check(now, timeouts.sender);
    lock.unlock();
    return sender.ok() ? Base::CheckCaller(now, timeouts) : sender;
  }

 protected:
  // Handles a request that came in order. An error ends the call.
  virtual absl::Status Take(Request& request) = 0;
  // A check that takes precedence over the order of requests.
  virtual absl::Status CheckWanted(const Request&) { return absl::OkStatus(); }
  // The caller half-closed before the finish. `status` is the error for that.
  virtual void TakeHalfClose(const absl::Status& status) { this->End(status); }

  void Read() {
    std::lock_guard lock(this->mutex_);
    if (this->finished_ || this->end_.has_value()) return;
    if (!sequence_.finished()) sender_.Await(Clock::now());
    this->StartRead(&request_);
  }

  RequestSequence sequence_;  // used only by read reactions, of which one runs at a time

 private:
  using Clock = std::chrono::steady_clock;

  void HalfClose() {
    absl::Status status = sequence_.HalfClose();
    if (status.ok()) return;
    // A stopping server ends reads before it cancels calls.
    if (this->facts_.gate->is_cut_off()) status = this->facts_.CancelStatus();
    {
      std::lock_guard lock(this->mutex_);
      this->half_closed_ = true;
    }
    TakeHalfClose(status);
  }

  Request request_;     // as sequence_
  SenderClock sender_;  // guarded by mutex_
};

// A streaming call that is refused.
template <typename Reactor>
class RefusedCall final : public Reactor {
 public:
  explicit RefusedCall(const absl::Status& why) { this->Finish(ToGrpcStatus(why)); }
  void OnDone() override { delete this; }
};

// Starts a call's handler. `facts` is of an admitted call, or why it was refused. Needs: what
// `more` refers to outlives the call.
template <typename Call, typename Facts, typename... More>
typename Call::ReactorType* StartCall(absl::StatusOr<Facts> facts, More&&... more) {
  if (!facts.ok()) return new RefusedCall<typename Call::ReactorType>(facts.status());
  const auto call = std::make_shared<Call>(*std::move(facts), std::forward<More>(more)...);
  call->Begin();
  return call.get();
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_STREAM_CALL_H_
