#include <grpcpp/alarm.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "server/calls/durable_messages.h"
#include "server/calls/event_queue.h"
#include "server/calls/services.h"
#include "server/calls/stream_call.h"

namespace bccskel::server {
namespace {

// Part of the interface: shorter than the idle timeouts of proxies.
constexpr std::chrono::seconds kHeartbeat(10);

using WatchBase =
    WritingCall<StreamCall<grpc::ServerWriteReactor<v1::WatchJobResponse>>, v1::WatchJobResponse>;

// A WatchJob call: sends a job's events, and heartbeats during silence.
class WatchCall final : public WatchBase, public JobWatcher {
 public:
  WatchCall(DurableCall call, const v1::WatchJobRequest& request)
      : WatchBase(std::move(call.facts)), durable_jobs_(call.durable_jobs) {
    subject_ = request.job();
    events_.StartAfter(request.after_sequence());
  }

  void Begin() {
    Open();
    auto watch = durable_jobs_.WatchJob(facts_.tenant, subject_, events_.sequence(), Self());
    std::lock_guard lock(mutex_);
    watch_ = std::move(watch);
    AwaitSilence();
  }
  void OnEvent(const JobEvent& event) override {
    std::lock_guard lock(mutex_);
    if (end_.has_value()) return;
    events_.Add(ToMessage(event));
    Advance();
  }
  void OnWatchEnd(const absl::Status& status) override { End(StorageError(status)); }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<v1::WatchJobResponse> Next() override {
    std::optional<v1::WatchJobResponse> next = events_.Next();
    if (!next.has_value() && heartbeat_due_) {
      next.emplace().set_sequence(events_.sequence());
      *next->mutable_time() = ToMessage(std::chrono::system_clock::now());
      next->mutable_heartbeat();
    }
    heartbeat_due_ = false;
    if (next.has_value()) written_ = Clock::now();
    return next;
  }
  void Advance() override {
    WatchBase::Advance();
    if (finished_) silence_ = nullptr;
  }
  void Closed() override {
    std::lock_guard lock(mutex_);
    if (const auto watch = std::move(watch_)) watch->Stop();
  }

  void AwaitSilence() {
    if (finished_) return;
    // A new one each time: an alarm must not be set in its own callback.
    silence_ = std::make_unique<grpc::Alarm>();
    const auto left = written_ + kHeartbeat - Clock::now();
    silence_->Set(std::chrono::system_clock::now() + left, [self = Self()](bool ok) {
      if (ok) self->OnAlarm();
    });
  }
  void OnAlarm() {
    std::lock_guard lock(mutex_);
    heartbeat_due_ = !writing() && Clock::now() >= written_ + kHeartbeat;
    if (heartbeat_due_) Advance();
    if (writing()) written_ = Clock::now();
    AwaitSilence();
  }
  std::shared_ptr<WatchCall> Self() {
    return std::static_pointer_cast<WatchCall>(shared_from_this());
  }

  DurableJobs& durable_jobs_;
  std::shared_ptr<Watch> watch_;          // guarded by mutex_, as are the members below
  std::unique_ptr<grpc::Alarm> silence_;  // null once the call has finished
  EventQueue events_;
  Clock::time_point written_ = Clock::now();
  bool heartbeat_due_ = false;
};

}  // namespace

grpc::ServerWriteReactor<v1::WatchJobResponse>* StartWatch(absl::StatusOr<DurableCall> call,
                                                           const v1::WatchJobRequest& request) {
  return StartCall<WatchCall>(std::move(call), request);
}

}  // namespace bccskel::server
