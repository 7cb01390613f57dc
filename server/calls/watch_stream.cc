#include "server/calls/watch_stream.h"

#include <grpcpp/alarm.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "server/durable/ledger.h"
#include "server/calls/durable_messages.h"
#include "server/calls/event_queue.h"
#include "server/calls/lasting_calls.h"
#include "server/calls/status_mapping.h"
#include "server/calls/refused_call.h"
#include "server/calls/status_mapping.h"

namespace bccskel::server {
namespace {

using Reactor = grpc::ServerWriteReactor<v1::WatchJobResponse>;
using Clock = std::chrono::system_clock;

// Part of the interface: proxies that close idle streams wait longer.
constexpr std::chrono::seconds kHeartbeat(10);

// A WatchJob call: tells the ledger's events, one write at a time. Events, writes and heartbeats
// come on different threads; the mutex orders them.
class WatchStream final : public Reactor,
                          public JobWatcher,
                          public LastingCall,
                          public std::enable_shared_from_this<WatchStream> {
 public:
  WatchStream(DurableCall call, const v1::WatchJobRequest& request)
      : call_(std::move(call)), job_(request.job()) {
    events_.StartAfter(request.after_sequence());
  }

  void Begin() {
    self_ = shared_from_this();
    std::unique_ptr<WatchHandle> handle =
        call_.ledger.WatchJob(call_.tenant(), job_, events_.sequence(), self_);
    std::lock_guard lock(mutex_);
    handle_ = std::move(handle);
    AwaitSilence();
    call_.facts.LookAfter(self_);
  }

  void OnEvent(const JobEvent& event) override;
  void OnWatchEnd(const absl::Status& status) override { End(StorageError(status)); }

  void EndEarly(const absl::Status& why) override { End(why); }

  void OnWriteDone(bool ok) override;
  void OnCancel() override { End(call_.facts.CancelStatus()); }
  void OnDone() override;

 private:
  void AwaitSilence();
  void OnAlarm();
  void End(const absl::Status& status);
  // Writes the next event, or finishes the call where all is told. Needs: mutex_ held.
  void Advance();
  void Write(v1::WatchJobResponse event);

  const DurableCall call_;
  const std::string job_;
  std::shared_ptr<WatchStream> self_;

  std::mutex mutex_;
  std::unique_ptr<WatchHandle> handle_;       // guarded by mutex_
  std::unique_ptr<grpc::Alarm> silence_;      // guarded by mutex_; null once ended
  EventQueue events_;                         // guarded by mutex_
  v1::WatchJobResponse response_;             // of the write in flight
  bool writing_ = false;                      // guarded by mutex_
  Clock::time_point written_ = Clock::now();  // guarded by mutex_
  std::optional<absl::Status> end_;           // guarded by mutex_
  bool finished_ = false;                     // guarded by mutex_
};

void WatchStream::OnEvent(const JobEvent& event) {
  std::lock_guard lock(mutex_);
  if (end_.has_value()) return;
  events_.Add(ToMessage(event));
  Advance();
}

void WatchStream::OnWriteDone(bool ok) {
  {
    std::lock_guard lock(mutex_);
    writing_ = false;
    if (ok || end_.has_value()) return Advance();
  }
  End(absl::CancelledError("the caller is gone"));
}

void WatchStream::End(const absl::Status& status) {
  std::lock_guard lock(mutex_);
  if (end_.has_value()) return;
  end_ = status;
  Advance();
}

void WatchStream::Advance() {
  if (finished_ || writing_) return;
  const bool cut_off = end_.has_value() && !end_->ok();
  std::optional<v1::WatchJobResponse> event = cut_off ? std::nullopt : events_.Next();
  if (event.has_value()) return Write(*std::move(event));
  if (!end_.has_value()) return;
  finished_ = true;
  silence_ = nullptr;
  Finish(ToGrpcStatus(*end_));
}

void WatchStream::Write(v1::WatchJobResponse event) {
  response_ = std::move(event);
  writing_ = true;
  written_ = Clock::now();
  StartWrite(&response_);
}

void WatchStream::AwaitSilence() {
  if (finished_) return;
  // A new one each time: an alarm must not be set from its own reaction.
  silence_ = std::make_unique<grpc::Alarm>();
  silence_->Set(written_ + kHeartbeat, [self = shared_from_this()](bool ok) {
    if (ok) self->OnAlarm();
  });
}

void WatchStream::OnAlarm() {
  std::lock_guard lock(mutex_);
  if (!finished_ && !writing_ && Clock::now() >= written_ + kHeartbeat) {
    v1::WatchJobResponse heartbeat;
    heartbeat.set_sequence(events_.sequence());
    *heartbeat.mutable_time() = ToMessage(Clock::now());
    heartbeat.mutable_heartbeat();
    Write(std::move(heartbeat));
  }
  if (writing_) written_ = Clock::now();
  AwaitSilence();
}

void WatchStream::OnDone() {
  const std::shared_ptr<WatchStream> self = std::move(self_);
  call_.facts.Leave(*this);
  std::unique_ptr<WatchHandle> handle;  // let go of without the lock: it waits for OnEvent()
  std::lock_guard lock(mutex_);
  call_.facts.LogEnded(job_, *end_);
  handle = std::move(handle_);
}

}  // namespace

grpc::ServerWriteReactor<v1::WatchJobResponse>* StartWatchStream(
    absl::StatusOr<DurableCall> call, const v1::WatchJobRequest& request) {
  if (!call.ok()) return new RefusedCall<Reactor>(call.status());
  const auto stream = std::make_shared<WatchStream>(*std::move(call), request);
  stream->Begin();
  return stream.get();
}

}  // namespace bccskel::server
