#include "server/calls/durable_session.h"

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/result.h"
#include "server/calls/durable_messages.h"
#include "server/calls/message_codec.h"
#include "server/calls/requests.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

// Smaller volumes are sent and computed again sooner than they are made durable.
constexpr uint64_t kSmallVolumeBytes = uint64_t{1} << 20;

}  // namespace

bool DurableSession::Suits(const v1::SkeletonizeConfig& config, const VolumeLimits& limits) {
  const absl::StatusOr<JobRequest> request = JobRequestOf(config, limits);
  return request.ok() && request->shell_points == ShellPointsWanted::kNone &&
         request->header.max_bricks > kSmallVolumeBytes / sizeof(BrickBits);
}

DurableSession::~DurableSession() {
  if (!upload_.empty() && !volume_sent_) durable_jobs_.SenderGone(tenant(), upload_);
}

template <typename Function>
auto DurableSession::Then(Function next) {
  return [self = shared_from_this(), next = std::move(next)](auto value) {
    if (!value.ok()) return self->call_->EndWith(StorageError(value.status()));
    next(*self, *value);
  };
}

absl::Status DurableSession::Begin(const v1::SkeletonizeConfig& config) {
  cancel_with_call_ = config.on_disconnect() == v1::DISCONNECT_POLICY_CANCEL;
  size_bytes_ = config.volume().size_bytes();
  BCCSKEL_ASSIGN_OR_RETURN(const std::string options,
                           OptionsBytes(config.options(), config.thin_volume_return()));
  NewUpload upload;
  upload.declaration = config.volume().SerializeAsString();
  upload.then_job = {
      .options = options, .threads = config.threads(), .trace = call_->facts().trace};
  durable_jobs_.CreateUpload(
      tenant(), upload, Then([](DurableSession& it, const UploadInfo& info) { it.Opened(info); }));
  return absl::OkStatus();
}

void DurableSession::Opened(const UploadInfo& upload) {
  call_->Accepted(upload.job, size_bytes_);
  {
    std::lock_guard lock(mutex_);
    upload_ = upload.name;
    job_ = upload.job;
    if (left_) return LeaveJob();  // nobody knows its name
  }
  writers_.Claim({tenant(), upload.name}, shared_from_this());
}

void DurableSession::OnTurn(UploadWriters::Turn turn) {
  turn_ = std::move(turn);
  call_->Change([this] {
    first_.Accept(job_, upload_);
    return Sending::kNow;
  });
  call_->ReadNext();
}

void DurableSession::OnTakenOver() {
  {
    std::lock_guard lock(mutex_);
    taken_over_ = true;
  }
  call_->EndWith(
      CallError(Reason::kSecondWriter, absl::StrCat("another stream goes on with ", upload_)));
}

void DurableSession::Append(v1::VolumeChunk& chunk) {
  std::optional<uint32_t> crc32c;
  if (chunk.has_crc32c()) crc32c = chunk.crc32c();
  durable_jobs_.Append(tenant(), upload_, chunk.offset(), std::move(*chunk.mutable_data()), crc32c,
                       Then([](DurableSession& it, uint64_t) { it.call_->ReadNext(); }));
}

void DurableSession::Finish(const v1::VolumeFinish& finish) {
  {
    std::lock_guard lock(mutex_);
    volume_sent_ = true;
  }
  durable_jobs_.FinishUpload(tenant(), upload_, finish.size_bytes(), DigestOf(finish),
                             Then([](DurableSession& it, const VolumeInfo&) {
                               it.WatchJob();
                               it.call_->ReadNext();  // sees requests that must not come
                             }));
}

void DurableSession::WatchJob() {
  auto watch = durable_jobs_.WatchJob(tenant(), job_, 0, shared_from_this());
  std::lock_guard lock(mutex_);
  if (closed_) return watch->Stop();
  watch_ = std::move(watch);
}

void DurableSession::OnEvent(const JobEvent& event) {
  if (const auto* progress = std::get_if<JobProgress>(&event.what)) {
    return call_->Change([&] {
      first_.Report(wire::ToMessage(progress->shell, progress->elapsed));
      return Sending::kNow;
    });
  }
  if (!event.IsCompleted()) return;
  const auto& change = std::get<JobEvent::StateChange>(event.what);
  if (change.state == JobState::kSucceeded) return OpenResult();
  call_->EndWith(change.error.ok() ? absl::CancelledError("the job was cancelled")
                                   : WithJobReason(change.error));
}

void DurableSession::OnWatchEnd(const absl::Status& status) {
  if (!status.ok()) call_->EndWith(StorageError(status));
}

void DurableSession::OpenResult() {
  durable_jobs_.OpenResult(tenant(), job_, 0,
                           Then([](DurableSession& it, std::shared_ptr<ResultReader> reader) {
                             it.reader_ = std::move(reader);
                             it.Fetch();
                           }));
}

void DurableSession::Fetch() {
  reader_->Next([self = shared_from_this()](absl::StatusOr<std::optional<ResultRecord>> record) {
    absl::Status status = record.status();
    if (status.ok() && !record->has_value()) {
      status = absl::InternalError("the stored result has no summary");
    }
    if (status.ok()) status = self->TakePiece(**std::move(record));
    if (!status.ok()) self->call_->EndWith(StorageError(status));
  });
}

absl::Status DurableSession::TakePiece(ResultRecord record) {
  v1::SkeletonizeResponse response;
  BCCSKEL_RETURN_IF_ERROR(SetPiece(std::move(record), response));
  call_->Change([&] {
    piece_ = std::move(response);
    return Sending::kNow;
  });
  return absl::OkStatus();
}

std::optional<v1::SkeletonizeResponse> DurableSession::Next() {
  return first_.HasFirst() ? first_.NextFirst() : std::exchange(piece_, std::nullopt);
}

void DurableSession::Leave(const absl::Status&) {
  std::lock_guard lock(mutex_);
  left_ = true;
  if (cancel_with_call_ && !taken_over_ && !job_.empty()) LeaveJob();
}

void DurableSession::LeaveJob() {
  if (volume_sent_) {
    durable_jobs_.CancelJob(tenant(), job_, [](const absl::StatusOr<JobInfo>&) {});
  } else {
    durable_jobs_.DeleteUpload(tenant(), upload_, [](const absl::Status&) {});
  }
}

void DurableSession::Close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
  if (const auto watch = std::move(watch_)) watch->Stop();
}

}  // namespace bccskel::server
