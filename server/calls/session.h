#ifndef BCCSKEL_SERVER_CALLS_SESSION_H_
#define BCCSKEL_SERVER_CALLS_SESSION_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bccskel/v1/volume.pb.h"
#include "server/calls/stream_call.h"

namespace bccskel::server {

template <typename Request, typename Response>
class SessionCall;

// What to send after a change: the result of Next() immediately, or together with the next
// response.
enum class Sending { kNow, kWithWhatFollows };

// The work of a call that sends a volume: a job in memory, a durable job, or labels. It receives
// the config first, then one request at a time.
template <typename Request, typename Response>
class Session {
 public:
  using Config = std::decay_t<decltype(std::declval<Request>().config())>;
  using Call = SessionCall<Request, Response>;  // the call that it serves

  virtual ~Session() = default;
  // An error ends the call.
  virtual absl::Status Begin(const Config& config) = 0;
  // The next chunk, which Append() may move from, and the finish. The session calls ReadNext()
  // after each.
  virtual void Append(v1::VolumeChunk& chunk) = 0;
  virtual void Finish(const v1::VolumeFinish& finish) = 0;

  // As in WritingCall.
  virtual std::optional<Response> Next() = 0;
  virtual Following Follows(const Response& response) const = 0;
  virtual void Fetch() {}

  // The call has failed. May be called at any time.
  virtual void Leave(const absl::Status& why) = 0;
  // The call is over.
  virtual void Close() = 0;
};

// A call that sends a volume, handed to a session.
template <typename Request, typename Response>
class SessionCall final
    : public ReceivingCall<
          WritingCall<StreamCall<grpc::ServerBidiReactor<Request, Response>>, Response>, Request> {
 public:
  using Work = Session<Request, Response>;
  using Config = typename Work::Config;
  // Selects the session by the config.
  using MakeSession =
      std::function<std::shared_ptr<Work>(const Config& config, std::shared_ptr<SessionCall> call)>;

  SessionCall(CallFacts facts, MakeSession make_session)
      : Base(std::move(facts)), make_session_(std::move(make_session)) {}

  void Begin() {
    this->Read();
    this->Open();
  }
  // ---- For the session. Threads: safe.
  const CallFacts& facts() const { return this->facts_; }
  // The job was admitted.
  void Accepted(const std::string& job, uint64_t volume_bytes) {
    this->facts_.LogAccepted(job, volume_bytes);
    std::lock_guard lock(this->mutex_);
    this->subject_ = job;
  }
  // Reads the next request.
  void ReadNext() { this->Read(); }
  // Runs `change` with the call's lock held, unless the call has ended.
  void Change(const std::function<Sending()>& change) {
    std::lock_guard lock(this->mutex_);
    if (this->finished_ || this->end_.has_value()) return;
    if (change() == Sending::kNow) this->Advance();
  }
  void EndWith(const absl::Status& status) { this->End(status); }

 private:
  using Base =
      ReceivingCall<WritingCall<StreamCall<grpc::ServerBidiReactor<Request, Response>>, Response>,
                    Request>;

  absl::Status Take(Request& request) override {
    if (request.has_chunk()) {
      session_->Append(*request.mutable_chunk());
    } else if (request.has_finish()) {
      session_->Finish(request.finish());
    } else {
      auto session = make_session_(request.config(),
                                   std::static_pointer_cast<SessionCall>(this->shared_from_this()));
      std::unique_lock lock(this->mutex_);
      if (this->finished_ || this->end_.has_value()) return absl::OkStatus();
      session_ = session;
      lock.unlock();
      return session->Begin(request.config());
    }
    return absl::OkStatus();
  }
  std::optional<Response> Next() override {
    return session_ == nullptr ? std::nullopt : session_->Next();
  }
  Following Follows(const Response& response) const override { return session_->Follows(response); }
  void Fetch() override { session_->Fetch(); }
  void Failed(const absl::Status& why) override {
    std::unique_lock lock(this->mutex_);
    const std::shared_ptr<Work> session = session_;
    lock.unlock();
    if (session != nullptr) session->Leave(why);
  }
  void Closed() override {
    std::unique_lock lock(this->mutex_);
    const std::shared_ptr<Work> session = std::move(session_);
    lock.unlock();
    if (session != nullptr) session->Close();
  }

  const MakeSession make_session_;
  std::shared_ptr<Work> session_;  // guarded by mutex_; set once, by a read reaction
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SESSION_H_
