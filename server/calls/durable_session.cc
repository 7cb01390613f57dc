#include "server/calls/durable_session.h"

#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/result.h"
#include "server/calls/durable_messages.h"
#include "server/calls/message_codec.h"
#include "server/calls/requests.h"
#include "server/calls/skeleton_responses.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

// Sending and computing a smaller volume again is faster than storing it.
constexpr uint64_t kSmallVolumeBytes = uint64_t{1} << 20;

class DurableSession final : public SkeletonizeSession,
                             public JobWatcher,
                             public UploadWriters::Writer,
                             public std::enable_shared_from_this<DurableSession> {
  // Makes a callback for DurableJobs that calls `next` with the value or ends the call with the
  // error.
  template <typename Function>
  auto Then(Function next) {
    return [self = shared_from_this(), next = std::move(next)](auto value) {
      if (!value.ok()) return self->call_->EndWith(StorageError(value.status()));
      next(*self, *value);
    };
  }
  // The same for a request about the upload. If that is gone, the error says why the job ended.
  template <typename Function>
  auto ThenOfUpload(Function next) {
    return [self = shared_from_this(), next = std::move(next)](auto value) {
      if (absl::IsNotFound(value.status())) return self->UploadGone(value.status());
      self->Then(next)(std::move(value));
    };
  }

 public:
  DurableSession(std::shared_ptr<Call> call, DurableJobs& durable_jobs, UploadWriters& writers)
      : call_(std::move(call)), durable_jobs_(durable_jobs), writers_(writers) {}
  // Runs when no call of DurableJobs is in progress, so that the next writer may begin.
  ~DurableSession() override {
    if (!upload_.empty() && !volume_sent_) durable_jobs_.SenderGone(tenant(), upload_);
  }

  absl::Status Begin(const v1::SkeletonizeConfig& config) override {
    cancel_with_call_ = config.on_disconnect() == v1::DISCONNECT_POLICY_CANCEL;
    size_bytes_ = config.volume().size_bytes();
    BCCSKEL_ASSIGN_OR_RETURN(const std::string options,
                             OptionsBytes(config.options(), config.thin_volume_return()));
    NewUpload upload;
    upload.declaration = DeclarationBytes(config.volume());
    upload.then_job = {
        .options = options, .threads = config.threads(), .trace = call_->facts().trace};
    durable_jobs_.CreateUpload(
        tenant(), upload,
        Then([](DurableSession& it, const UploadInfo& info) { it.Opened(info); }));
    return absl::OkStatus();
  }
  void Append(v1::VolumeChunk& chunk) override {
    const std::optional<uint32_t> crc32c = Crc32cOf(chunk);
    durable_jobs_.Append(tenant(), upload_, chunk.offset(), std::move(*chunk.mutable_data()),
                         crc32c,
                         ThenOfUpload([](DurableSession& it, uint64_t) { it.call_->ReadNext(); }));
  }
  void Finish(const v1::VolumeFinish& finish) override {
    {
      std::lock_guard lock(mutex_);
      volume_sent_ = true;
    }
    durable_jobs_.FinishUpload(tenant(), upload_, finish.size_bytes(), DigestOf(finish),
                               ThenOfUpload([](DurableSession& it, const VolumeInfo&) {
                                 it.WatchJob();
                                 it.call_->ReadNext();  // to detect requests after the finish
                               }));
  }
  std::optional<v1::SkeletonizeResponse> Next() override {
    return first_.HasFirst() ? first_.NextFirst() : std::exchange(piece_, std::nullopt);
  }
  Following Follows(const v1::SkeletonizeResponse& response) const override {
    if (response.has_summary()) return Following::kNothing;
    const bool chunk = response.response_case() == v1::SkeletonizeResponse::RESPONSE_NOT_SET;
    return chunk ? Following::kFetchedAtOnce : Following::kLater;
  }
  void Fetch() override {
    reader_->Next([self = shared_from_this()](absl::StatusOr<std::optional<ResultRecord>> record) {
      absl::Status status = record.status();
      if (status.ok() && !record->has_value()) {
        status = absl::InternalError("the stored result has no summary");
      }
      if (status.ok()) status = self->TakePiece(**std::move(record));
      if (!status.ok()) self->call_->EndWith(StorageError(status));
    });
  }
  void Leave(const absl::Status&) override {
    std::lock_guard lock(mutex_);
    left_ = true;
    if (cancel_with_call_ && !taken_over_ && !job_.empty()) LeaveJob();
  }
  void Close() override {
    std::lock_guard lock(mutex_);
    closed_ = true;
    if (const auto watch = std::move(watch_)) watch->Stop();
  }

  void OnEvent(const JobEvent& event) override {
    if (const auto* progress = std::get_if<JobProgress>(&event.what)) {
      return call_->Change([&] {
        first_.Report(wire::ToMessage(progress->shell, progress->elapsed));
        return Sending::kNow;
      });
    }
    if (!event.IsCompleted()) return;
    const auto& change = std::get<JobEvent::StateChange>(event.what);
    if (change.state == JobState::kSucceeded) return OpenResult();
    call_->EndWith(JobError(change.error));
  }
  void OnWatchEnd(const absl::Status& status) override {
    if (!status.ok()) call_->EndWith(StorageError(status));
  }
  void OnTurn(UploadWriters::Turn turn) override {
    turn_ = std::move(turn);
    call_->Change([this] {
      first_.Accept(job_, upload_);
      return Sending::kNow;
    });
    call_->ReadNext();
  }
  void OnTakenOver() override {
    {
      std::lock_guard lock(mutex_);
      taken_over_ = true;
    }
    call_->EndWith(
        CallError(Reason::kSecondWriter, absl::StrCat("another stream has taken over ", upload_)));
  }

 private:
  void Opened(const UploadInfo& upload) {
    call_->Accepted(upload.job, size_bytes_);
    {
      std::lock_guard lock(mutex_);
      upload_ = upload.name;
      job_ = upload.job;
      if (left_) return LeaveJob();  // the caller does not know its name
    }
    writers_.Claim({tenant(), upload.name}, shared_from_this());
  }
  static absl::Status JobError(const absl::Status& error) {
    return error.ok() ? JobCancelled() : WithJobReason(error);
  }
  void UploadGone(const absl::Status& error) {
    durable_jobs_.GetJob(tenant(), job_,
                         [self = shared_from_this(), error](const absl::StatusOr<JobInfo>& job) {
                           absl::Status end = error;
                           if (absl::IsNotFound(job.status()))
                             end = absl::CancelledError("the job was deleted");
                           if (job.ok() && IsTerminal(job->state)) end = JobError(job->error);
                           self->call_->EndWith(StorageError(end));
                         });
  }
  void WatchJob() {
    auto watch = durable_jobs_.WatchJob(tenant(), job_, 0, shared_from_this());
    std::lock_guard lock(mutex_);
    if (closed_) return watch->Stop();
    watch_ = std::move(watch);
  }
  void OpenResult() {
    durable_jobs_.OpenResult(tenant(), job_, 0,
                             Then([](DurableSession& it, std::shared_ptr<ResultReader> reader) {
                               it.reader_ = std::move(reader);
                               it.Fetch();
                             }));
  }
  absl::Status TakePiece(ResultRecord record) {
    v1::SkeletonizeResponse response;
    BCCSKEL_RETURN_IF_ERROR(SetPiece(std::move(record), response));
    call_->Change([&] {
      piece_ = std::move(response);
      return Sending::kNow;
    });
    return absl::OkStatus();
  }
  const std::string& tenant() const { return call_->facts().tenant; }
  // Erases what has arrived of the volume, or ends the job. Does nothing once the job has ended.
  // Needs: mutex_ held.
  void LeaveJob() {
    if (volume_sent_) {
      durable_jobs_.CancelJob(tenant(), job_, [](const absl::StatusOr<JobInfo>&) {});
    } else {
      durable_jobs_.DeleteUpload(tenant(), upload_, [](const absl::Status&) {});
    }
  }

  const std::shared_ptr<Call> call_;
  DurableJobs& durable_jobs_;
  UploadWriters& writers_;
  // Used by one request or its answer at a time.
  uint64_t size_bytes_ = 0;
  bool cancel_with_call_ = false;
  UploadWriters::Turn turn_;
  std::shared_ptr<ResultReader> reader_;
  // Guarded by the call's lock.
  FirstOfSkeleton first_;
  std::optional<v1::SkeletonizeResponse> piece_;

  std::mutex mutex_;
  std::string upload_, job_;  // set with mutex_ held, by Opened()
  bool volume_sent_ = false;  // guarded by mutex_, as are the members below
  bool taken_over_ = false;   // by another stream, which continues the job
  bool left_ = false;         // the call has failed
  bool closed_ = false;       // and gRPC is done with it
  std::shared_ptr<Watch> watch_;
};

}  // namespace

bool IsDurable(const v1::SkeletonizeConfig& config, const VolumeLimits& limits) {
  const absl::StatusOr<JobRequest> request = JobRequestOf(config, limits);
  return request.ok() && request->shell_points == ShellPointsWanted::kNone &&
         request->header.max_bricks > kSmallVolumeBytes / sizeof(BrickBits);
}

std::shared_ptr<SkeletonizeSession> MakeDurableSession(
    std::shared_ptr<SkeletonizeSession::Call> call, DurableJobs& durable_jobs,
    UploadWriters& writers) {
  return std::make_shared<DurableSession>(std::move(call), durable_jobs, writers);
}

}  // namespace bccskel::server
