#include "server/calls/durable_skeletonize.h"

#include <variant>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/result.h"
#include "server/calls/message_codec.h"
#include "server/calls/durable_messages.h"
#include "server/calls/job_request.h"
#include "server/calls/status_mapping.h"
#include "server/calls/response_outbox.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

// Smaller volumes are sent and computed again sooner than they are made durable.
constexpr uint64_t kSmallVolumeBytes = uint64_t{1} << 20;

v1::SkeletonizeResponse ToResponse(v1::ReadSkeletonResponse piece) {
  v1::SkeletonizeResponse response;
  if (piece.has_skeleton_chunk()) {
    response.mutable_skeleton_chunk()->Swap(piece.mutable_skeleton_chunk());
  } else if (piece.has_thin_volume_chunk()) {
    response.mutable_thin_volume_chunk()->Swap(piece.mutable_thin_volume_chunk());
  } else {
    response.mutable_summary()->Swap(piece.mutable_summary());
  }
  return response;
}

}  // namespace

bool DurableSkeletonize::Suits(const v1::SkeletonizeConfig& config, const VolumeLimits& limits) {
  const absl::StatusOr<JobRequest> request = JobRequestOf(config, limits);
  return request.ok() && request->shell_points == ShellPointsWanted::kNone &&
         request->header.max_bricks > kSmallVolumeBytes / sizeof(BrickBits);
}

DurableSkeletonize::~DurableSkeletonize() {
  if (!upload_.empty() && !sequence_.finished()) {
    call_.ledger.SenderGone(call_.tenant(), upload_);
  }
}

// What the ledger calls: `next` with the value, or the end of the call.
template <typename Next>
auto DurableSkeletonize::Then(Next next) {
  return [self = shared_from_this(), next = std::move(next)](auto value) {
    if (!value.ok()) return self->End(StorageError(value.status()));
    next(*self, *value);
  };
}

void DurableSkeletonize::Begin(const v1::SkeletonizeConfig& config) {
  cancel_with_stream_ = config.on_disconnect() == v1::DISCONNECT_POLICY_CANCEL;
  size_bytes_ = config.volume().size_bytes();
  v1::SkeletonizeRequest first;
  *first.mutable_config() = config;
  absl::Status begun = sequence_.Take(first);
  const auto options = OptionsBytes(config.options(), config.thin_volume_return());
  if (begun.ok()) begun = options.status();
  if (!begun.ok()) return End(begun);
  Ledger::NewUpload upload;
  upload.declaration = DeclarationBytes(config.volume());
  upload.then_job = {.options = *options, .threads = config.threads(), .trace = call_.facts.trace};
  call_.ledger.CreateUpload(
      call_.tenant(), upload,
      Then([](DurableSkeletonize& it, const UploadInfo& info) { it.Opened(info); }));
}

void DurableSkeletonize::Opened(const UploadInfo& upload) {
  call_.facts.LogAccepted(upload.job, size_bytes_);
  {
    std::lock_guard lock(mutex_);
    upload_ = upload.name;
    job_ = upload.job;
    if (error_.has_value()) return LeaveJob();  // nobody knows its name
    accepted_ = AcceptedFor(job_);
    accepted_->set_durable(true);
    accepted_->set_upload(upload_);
  }
  writers_.Claim({call_.tenant(), upload.name}, shared_from_this());
}

void DurableSkeletonize::OnTurn(UploadWriters::Turn turn) {
  turn_ = std::move(turn);
  {
    std::lock_guard lock(mutex_);
    Advance();
  }
  ReadNext();
}

void DurableSkeletonize::OnTakenOver() {
  End(CallError(Reason::kSecondWriter, absl::StrCat("another stream goes on with ", upload_)),
      Leaving::kToAnotherStream);
}

void DurableSkeletonize::OnReadDone(bool ok) {
  if (!ok) return HalfClose();
  {
    std::lock_guard lock(mutex_);
    const uint64_t bytes = request_.has_chunk() ? request_.chunk().data().size() : 0;
    sender_.Take(std::chrono::steady_clock::now(), bytes);
  }
  const absl::Status status = sequence_.Take(request_);
  if (!status.ok()) return End(status);
  Take(request_);
}

void DurableSkeletonize::HalfClose() {
  const absl::Status status = sequence_.HalfClose();
  if (status.ok()) return;
  {
    std::lock_guard lock(mutex_);
    half_closed_ = true;
  }
  End(status);
}

void DurableSkeletonize::OnCancel() {
  const absl::Status status = call_.facts.CancelStatus();
  {
    std::lock_guard lock(mutex_);
    // A connection that breaks looks like a half-close at first.
    if (half_closed_ && error_.has_value()) error_ = status;
  }
  End(status);
}

void DurableSkeletonize::Take(v1::SkeletonizeRequest& request) {
  if (request.has_chunk()) {
    v1::VolumeChunk& chunk = *request.mutable_chunk();
    std::optional<uint32_t> crc32c;
    if (chunk.has_crc32c()) crc32c = chunk.crc32c();
    return call_.ledger.Append(call_.tenant(), upload_, chunk.offset(),
                               std::move(*chunk.mutable_data()), crc32c,
                               Then([](DurableSkeletonize& it, uint64_t) { it.ReadNext(); }));
  }
  {
    std::lock_guard lock(mutex_);
    volume_sent_ = true;
  }
  const v1::VolumeFinish& finish = request.finish();
  call_.ledger.FinishUpload(call_.tenant(), upload_, finish.size_bytes(), DigestOf(finish),
                            Then([](DurableSkeletonize& it, const VolumeInfo&) {
                              it.Watch();
                              it.ReadNext();  // sees requests that must not come
                            }));
}

void DurableSkeletonize::Watch() {
  std::unique_ptr<WatchHandle> handle =
      call_.ledger.WatchJob(call_.tenant(), job_, 0, shared_from_this());
  std::lock_guard lock(mutex_);
  if (!ended_) handle_ = std::move(handle);
}

void DurableSkeletonize::OnEvent(const JobEvent& event) {
  if (const auto* progress = std::get_if<JobProgress>(&event.what)) {
    std::lock_guard lock(mutex_);
    progress_ = wire::ToMessage(progress->shell, progress->elapsed);
    return Advance();
  }
  if (event.IsCompleted()) OnJobEnd(std::get<JobEvent::StateChange>(event.what));
}

void DurableSkeletonize::OnJobEnd(const JobEvent::StateChange& change) {
  if (change.state == JobState::kSucceeded) return OpenResult();
  End(change.error.ok() ? absl::CancelledError("the job was cancelled")
                        : WithJobReason(change.error));
}

void DurableSkeletonize::OnWatchEnd(const absl::Status& status) {
  if (!status.ok()) End(StorageError(status));
}

void DurableSkeletonize::OpenResult() {
  call_.ledger.OpenResult(call_.tenant(), job_, 0,
                          Then([](DurableSkeletonize& it, std::shared_ptr<ResultReader> reader) {
                            it.reader_ = std::move(reader);
                            it.ReadPiece();
                          }));
}

void DurableSkeletonize::ReadPiece() {
  reader_->Next([self = shared_from_this()](absl::StatusOr<std::optional<ResultRecord>> record) {
    absl::Status status = record.status();
    if (status.ok() && !record->has_value()) {
      status = absl::InternalError("the stored result has no summary");
    }
    if (status.ok()) status = self->TakePiece(**record);
    if (!status.ok()) self->End(StorageError(status));
  });
}

absl::Status DurableSkeletonize::TakePiece(const ResultRecord& record) {
  BCCSKEL_ASSIGN_OR_RETURN(v1::ReadSkeletonResponse piece, ToMessage(record, 0));
  std::lock_guard lock(mutex_);
  piece_ = ToResponse(std::move(piece));
  Advance();
  return absl::OkStatus();
}

void DurableSkeletonize::OnWriteDone(bool ok) {
  bool more = false;
  {
    std::lock_guard lock(mutex_);
    writing_ = false;
    more = ResponseOutbox::IsPiece(response_) && ok && !error_.has_value();
    if (ok || error_.has_value()) Advance();
  }
  if (!ok) return End(absl::CancelledError("the caller is gone"));
  if (more) ReadPiece();
}

void DurableSkeletonize::ReadNext() {
  std::lock_guard lock(mutex_);
  if (ended_ || error_.has_value()) return;
  if (!sequence_.finished()) sender_.Await(std::chrono::steady_clock::now());
  stream_.StartRead(&request_);
}

absl::Status DurableSkeletonize::CheckSender(SenderClock::TimePoint now,
                                             std::chrono::milliseconds limit) {
  std::lock_guard lock(mutex_);
  return sender_.Check(now, limit);
}

void DurableSkeletonize::End(const absl::Status& status, Leaving leaving) {
  std::lock_guard lock(mutex_);
  if (ended_ || error_.has_value()) return;
  error_ = status;
  if (cancel_with_stream_ && leaving == Leaving::kByPolicy && !job_.empty()) LeaveJob();
  Advance();
}

// Erases what came of the volume, or ends the job. Changes nothing once the job has ended.
// Needs: mutex_ held.
void DurableSkeletonize::LeaveJob() {
  if (volume_sent_) {
    call_.ledger.CancelJob(call_.tenant(), job_, [](const absl::StatusOr<JobInfo>&) {});
  } else {
    call_.ledger.DeleteUpload(call_.tenant(), upload_, [](const absl::Status&) {});
  }
}

std::optional<v1::SkeletonizeResponse> DurableSkeletonize::NextResponse() {
  v1::SkeletonizeResponse response;
  if (accepted_.has_value()) {
    *response.mutable_accepted() = *std::exchange(accepted_, std::nullopt);
    return response;
  }
  if (progress_.has_value()) {
    *response.mutable_shell_progress() = *std::exchange(progress_, std::nullopt);
    return response;
  }
  return std::exchange(piece_, std::nullopt);
}

void DurableSkeletonize::Advance() {
  if (ended_ || writing_) return;
  if (error_.has_value()) {
    ended_ = true;
    return stream_.Finish(ToGrpcStatus(*error_));
  }
  auto response = NextResponse();
  if (!response.has_value()) return;
  response_ = *std::move(response);
  writing_ = true;
  if (response_.has_summary()) {
    ended_ = true;
    return stream_.StartWriteAndFinish(&response_, grpc::WriteOptions(), grpc::Status::OK);
  }
  grpc::WriteOptions options;
  // More of the result follows at once, so gRPC may send it together.
  if (ResponseOutbox::IsPiece(response_)) options.set_buffer_hint();
  stream_.StartWrite(&response_, options);
}

void DurableSkeletonize::OnDone() {
  std::unique_ptr<WatchHandle> handle;  // let go of without the lock: it waits for OnEvent()
  std::lock_guard lock(mutex_);
  call_.facts.LogEnded(job_, error_.value_or(absl::OkStatus()));
  handle = std::move(handle_);
}

}  // namespace bccskel::server
