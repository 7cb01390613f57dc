#ifndef BCCSKEL_SERVER_CALLS_DURABLE_SKELETONIZE_H_
#define BCCSKEL_SERVER_CALLS_DURABLE_SKELETONIZE_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "server/durable/ledger.h"
#include "server/calls/durable_gate.h"
#include "server/calls/request_sequence.h"
#include "server/calls/sender_clock.h"
#include "server/calls/upload_writers.h"

namespace bccskel::server {

// A Skeletonize call whose upload and job the ledger keeps. It reacts for the stream that it is
// given: uploads, watches the job, reads the stored result. At most one write is in flight, and one
// chunk or one piece of the result is in memory.
//
// Requests and pieces come one after the other; cancelling, events and being taken over come at any
// time, hence the mutex. The stream's functions are called with the mutex held and never after it
// has ended: the stream may be gone then, while the ledger still answers.
class DurableSkeletonize final : public JobWatcher,
                                 public UploadWriters::Writer,
                                 public std::enable_shared_from_this<DurableSkeletonize> {
 public:
  using Stream = grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>;

  // Whether a call with this config is durable where there is a ledger: volumes that may take more
  // than 1 MiB decoded are.
  static bool Suits(const v1::SkeletonizeConfig& config, const VolumeLimits& limits);

  // Needs: `stream` lives until it is done, the rest until this is gone.
  DurableSkeletonize(DurableCall call, UploadWriters& writers, Stream& stream)
      : call_(std::move(call)), writers_(writers), stream_(stream) {}
  ~DurableSkeletonize() override;

  // Needs: `config` was found right.
  void Begin(const v1::SkeletonizeConfig& config);

  // The stream's reactions; from Begin() on it reads into request_.
  void OnReadDone(bool ok);
  void OnWriteDone(bool ok);
  void OnCancel();
  void OnDone();
  // As LastingCall.
  void EndEarly(const absl::Status& why) { End(why); }
  absl::Status CheckSender(SenderClock::TimePoint now, std::chrono::milliseconds limit);

  void OnEvent(const JobEvent& event) override;
  void OnWatchEnd(const absl::Status& status) override;
  void OnTurn(UploadWriters::Turn turn) override;
  void OnTakenOver() override;

 private:
  void HalfClose();
  void Take(v1::SkeletonizeRequest& request);
  void Opened(const UploadInfo& upload);
  void Watch();
  void OnJobEnd(const JobEvent::StateChange& change);
  void OpenResult();
  void ReadPiece();
  absl::Status TakePiece(const ResultRecord& record);

  template <typename Next>
  auto Then(Next next);
  void ReadNext();
  enum class Leaving { kByPolicy, kToAnotherStream };
  void End(const absl::Status& status, Leaving leaving = Leaving::kByPolicy);
  void LeaveJob();
  // Writes the next response or finishes the call, if it is time. Needs: mutex_ held.
  void Advance();
  std::optional<v1::SkeletonizeResponse> NextResponse();

  const DurableCall call_;
  UploadWriters& writers_;
  Stream& stream_;

  // Used by one reaction at a time.
  v1::SkeletonizeRequest request_;
  RequestSequence sequence_;
  uint64_t size_bytes_ = 0;
  UploadWriters::Turn turn_;
  std::shared_ptr<ResultReader> reader_;

  std::mutex mutex_;
  SenderClock sender_;                               // guarded by mutex_
  bool cancel_with_stream_ = false;                  // set by Begin()
  bool volume_sent_ = false;                         // guarded by mutex_
  std::string upload_, job_;                         // guarded by mutex_ until accepted
  std::unique_ptr<WatchHandle> handle_;              // guarded by mutex_
  std::optional<v1::SkeletonizeAccepted> accepted_;  // guarded by mutex_, as what follows
  std::optional<v1::ShellProgress> progress_;
  std::optional<v1::SkeletonizeResponse> piece_;
  v1::SkeletonizeResponse response_;  // of the write in flight
  bool writing_ = false;
  std::optional<absl::Status> error_;
  bool half_closed_ = false;  // before the finish
  bool ended_ = false;        // the stream is not to be touched any more
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_DURABLE_SKELETONIZE_H_
