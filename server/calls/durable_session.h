#ifndef BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_
#define BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "server/calls/session.h"
#include "server/calls/skeleton_responses.h"
#include "server/calls/upload_writers.h"
#include "server/durable/durable_jobs.h"

namespace bccskel::server {

// A Skeletonize call whose upload and job are kept: uploads, watches the job, reads the stored
// result, of which one piece is in memory at a time.
class DurableSession final : public Session<v1::SkeletonizeRequest, v1::SkeletonizeResponse>,
                             public JobWatcher,
                             public UploadWriters::Writer,
                             public std::enable_shared_from_this<DurableSession> {
 public:
  // Whether a call with this config is durable where anything is: volumes that may take more than
  // 1 MiB decoded are.
  static bool Suits(const v1::SkeletonizeConfig& config, const VolumeLimits& limits);

  // Needs: `DurableJobs` and `writers` outlive the session.
  DurableSession(std::shared_ptr<Call> call, DurableJobs& durable_jobs, UploadWriters& writers)
      : call_(std::move(call)), durable_jobs_(durable_jobs), writers_(writers) {}
  // No call of DurableJobs is under way any more, so that the next writer may begin.
  ~DurableSession() override;

  absl::Status Begin(const v1::SkeletonizeConfig& config) override;
  void Append(v1::VolumeChunk& chunk) override;
  void Finish(const v1::VolumeFinish& finish) override;
  std::optional<v1::SkeletonizeResponse> Next() override;
  Following Follows(const v1::SkeletonizeResponse& response) const override {
    if (response.has_summary()) return Following::kNothing;
    const bool chunk = response.response_case() == v1::SkeletonizeResponse::RESPONSE_NOT_SET;
    return chunk ? Following::kFetchedAtOnce : Following::kLater;
  }
  void Fetch() override;
  void Leave(const absl::Status& why) override;
  void Close() override;

  void OnEvent(const JobEvent& event) override;
  void OnWatchEnd(const absl::Status& status) override;
  void OnTurn(UploadWriters::Turn turn) override;
  void OnTakenOver() override;

 private:
  void Opened(const UploadInfo& upload);
  void WatchJob();
  void OpenResult();
  absl::Status TakePiece(ResultRecord record);
  // What DurableJobs calls: `next` with the value, or the end of the call.
  template <typename Function>
  auto Then(Function next);
  const std::string& tenant() const { return call_->facts().tenant; }
  // Erases what came of the volume, or ends the job. Changes nothing once the job has ended.
  // Needs: mutex_ held.
  void LeaveJob();

  const std::shared_ptr<Call> call_;
  DurableJobs& durable_jobs_;
  UploadWriters& writers_;
  // Used by one request, or answer to one, at a time.
  uint64_t size_bytes_ = 0;
  bool cancel_with_call_ = false;
  UploadWriters::Turn turn_;
  std::shared_ptr<ResultReader> reader_;
  // Guarded by the call's lock.
  FirstOfSkeleton first_;
  std::optional<v1::SkeletonizeResponse> piece_;

  std::mutex mutex_;
  std::string upload_, job_;  // set with mutex_ held, by Opened()
  bool volume_sent_ = false;  // guarded by mutex_, as what follows
  bool taken_over_ = false;   // by another stream, which goes on with the job
  bool left_ = false;         // the call has failed
  bool closed_ = false;       // and gRPC is done with it
  std::shared_ptr<Watch> watch_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_
