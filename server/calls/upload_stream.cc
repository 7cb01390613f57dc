#include "server/calls/upload_stream.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/calls/message_codec.h"
#include "server/calls/durable_messages.h"
#include "server/calls/job_request.h"
#include "server/calls/lasting_calls.h"
#include "server/calls/status_mapping.h"
#include "server/calls/refused_call.h"
#include "server/calls/request_sequence.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using Reactor = grpc::ServerReadReactor<v1::UploadVolumeRequest>;

absl::Status CheckVolumeBytes(uint64_t bytes, const JobPool::Limits& limits) {
  if (bytes <= limits.max_volume_bytes) return absl::OkStatus();
  return CallError(Reason::kVolumeTooLarge, absl::StrCat("the declared volume has ", bytes, " bytes, the limit is ",
                             limits.max_volume_bytes), {.quota = "max_volume_bytes"});
}

// An UploadVolume call: hands one chunk after the other to the ledger and reads no further before
// the ledger has room. Reactions come one after the other, on gRPC's or the ledger's threads;
// cancelling and taking over come at any time, hence the mutex.
class UploadStream final : public Reactor,
                           public UploadWriters::Writer,
                           public LastingCall,
                           public std::enable_shared_from_this<UploadStream> {
 public:
  UploadStream(DurableCall call, UploadWriters& writers, const JobPool::Limits& limits,
               v1::UploadVolumeResponse& response)
      : call_(std::move(call)), writers_(writers), limits_(limits), response_(response) {}
  // No call of the ledger is under way any more, so that the next writer may begin.
  ~UploadStream() override {
    if (open_ && !sequence_.finished()) call_.ledger.SenderGone(call_.tenant(), upload_);
  }

  void Begin() {
    self_ = shared_from_this();
    StartRead(&request_);
    call_.facts.LookAfter(self_);
  }

  void EndEarly(const absl::Status& why) override { End(why); }

  void OnReadDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

  void OnTurn(UploadWriters::Turn turn) override;
  void OnTakenOver() override {
    End(CallError(Reason::kSecondWriter, absl::StrCat("another stream goes on with ", upload_)));
  }

 private:
  void HalfClose();
  absl::Status CheckWanted() const;
  absl::Status Take(v1::UploadVolumeRequest& request);
  absl::Status Open(const v1::UploadVolumeConfig& config);
  void Create();
  void Resume(const UploadInfo& upload);
  void Append(v1::VolumeChunk& chunk);
  void FinishVolume(const v1::VolumeFinish& finish);
  // Answers how far the upload is and ends the call.
  void AnswerStatus(const std::string& blob_digest);

  // What the ledger calls: `next` with the value, or the end of the call.
  template <typename Next>
  auto Then(Next next) {
    return [self = shared_from_this(), next = std::move(next)](auto value) {
      if (!value.ok()) return self->End(StorageError(value.status()));
      next(*self, *value);
    };
  }
  void ReadNext();
  void End(const absl::Status& status);

  const DurableCall call_;
  UploadWriters& writers_;
  const JobPool::Limits limits_;
  std::shared_ptr<UploadStream> self_;

  // Used by one reaction at a time.
  UploadWriters::Turn turn_;
  v1::UploadVolumeRequest request_;
  RequestSequence sequence_;
  std::string upload_;
  std::string declaration_;
  bool open_ = false;
  bool complete_ = false;  // it was, before this call

  std::mutex mutex_;
  v1::UploadVolumeResponse& response_;  // guarded by mutex_; gone once there is an end_
  std::optional<absl::Status> end_;     // guarded by mutex_
  bool half_closed_ = false;            // guarded by mutex_: before the finish
};

void UploadStream::OnReadDone(bool ok) {
  if (!ok) return HalfClose();
  absl::Status status = CheckWanted();
  if (status.ok()) status = sequence_.Take(request_);
  if (status.ok()) status = Take(request_);
  if (!status.ok()) End(status);
}

void UploadStream::HalfClose() {
  if (sequence_.finished()) return;  // the answer is on its way
  {
    std::lock_guard lock(mutex_);
    half_closed_ = true;
  }
  if (!open_) return End(sequence_.HalfClose());
  AnswerStatus("");
}

absl::Status UploadStream::CheckWanted() const {
  if (!complete_ || !request_.has_chunk()) return absl::OkStatus();
  return CallError(Reason::kUploadFinished, absl::StrCat(upload_, " is finished and takes no more chunks"));
}

absl::Status UploadStream::Take(v1::UploadVolumeRequest& request) {
  if (request.has_config()) return Open(request.config());
  if (request.has_chunk()) {
    Append(*request.mutable_chunk());
  } else {
    FinishVolume(request.finish());
  }
  return absl::OkStatus();
}

absl::Status UploadStream::Open(const v1::UploadVolumeConfig& config) {
  if (config.upload().empty()) return InvalidField("config.upload", "must be set");
  v1::SkeletonizeConfig whole;
  *whole.mutable_volume() = config.volume();
  BCCSKEL_RETURN_IF_ERROR(JobRequestOf(whole, limits_.volume).status());
  BCCSKEL_RETURN_IF_ERROR(CheckVolumeBytes(config.volume().size_bytes(), limits_));
  upload_ = config.upload();
  declaration_ = DeclarationBytes(config.volume());
  writers_.Claim({call_.tenant(), upload_}, shared_from_this());
  return absl::OkStatus();
}

void UploadStream::OnTurn(UploadWriters::Turn turn) {
  turn_ = std::move(turn);
  call_.ledger.GetUpload(
      call_.tenant(), upload_, [self = shared_from_this()](absl::StatusOr<UploadInfo> upload) {
        if (absl::IsNotFound(upload.status())) return self->Create();
        self->Then([](UploadStream& it, const UploadInfo& found) { it.Resume(found); })(
            std::move(upload));
      });
}

void UploadStream::Create() {
  Ledger::NewUpload upload;
  upload.name = upload_;
  upload.declaration = declaration_;
  call_.ledger.CreateUpload(
      call_.tenant(), upload,
      Then([](UploadStream& it, const UploadInfo& info) { it.Resume(info); }));
}

void UploadStream::Resume(const UploadInfo& upload) {
  if (upload.declaration != declaration_) {
    return End(CallError(Reason::kUploadExists, absl::StrCat(upload_, " was begun with another declaration")));
  }
  open_ = true;
  complete_ = !upload.volume.empty();
  sequence_.ResumeAt(upload.committed_bytes);
  ReadNext();
}

void UploadStream::Append(v1::VolumeChunk& chunk) {
  std::optional<uint32_t> crc32c;
  if (chunk.has_crc32c()) crc32c = chunk.crc32c();
  call_.ledger.Append(call_.tenant(), upload_, chunk.offset(), std::move(*chunk.mutable_data()),
                      crc32c, Then([](UploadStream& it, uint64_t) { it.ReadNext(); }));
}

void UploadStream::FinishVolume(const v1::VolumeFinish& finish) {
  call_.ledger.FinishUpload(call_.tenant(), upload_, finish.size_bytes(), DigestOf(finish),
                            Then([](UploadStream& it, const VolumeInfo& volume) {
                              it.AnswerStatus(absl::HexStringToBytes(volume.blob_digest));
                            }));
}

void UploadStream::AnswerStatus(const std::string& blob_digest) {
  call_.ledger.GetUpload(call_.tenant(), upload_,
                         Then([blob_digest](UploadStream& it, const UploadInfo& upload) {
                           {
                             std::lock_guard lock(it.mutex_);
                             if (it.end_.has_value()) return;
                             *it.response_.mutable_upload() = ToMessage(upload);
                             it.response_.set_blob_sha256(blob_digest);
                           }
                           it.End(absl::OkStatus());
                         }));
}

void UploadStream::ReadNext() {
  std::lock_guard lock(mutex_);
  if (!end_.has_value()) StartRead(&request_);
}

void UploadStream::End(const absl::Status& status) {
  std::lock_guard lock(mutex_);
  if (end_.has_value()) return;
  end_ = status;
  Finish(ToGrpcStatus(status));
}

void UploadStream::OnCancel() {
  const absl::Status status = call_.facts.CancelStatus();
  {
    std::lock_guard lock(mutex_);
    // A connection that breaks looks like a half-close at first.
    if (half_closed_ && end_.has_value()) end_ = status;
  }
  End(status);
}

void UploadStream::OnDone() {
  const std::shared_ptr<UploadStream> self = std::move(self_);
  call_.facts.Leave(*this);
  std::lock_guard lock(mutex_);
  call_.facts.LogEnded(upload_, *end_);
}

}  // namespace

grpc::ServerReadReactor<v1::UploadVolumeRequest>* StartUploadStream(
    absl::StatusOr<DurableCall> call, UploadWriters& writers, const JobPool::Limits& limits,
    v1::UploadVolumeResponse& response) {
  if (!call.ok()) return new RefusedCall<Reactor>(call.status());
  const auto stream = std::make_shared<UploadStream>(*std::move(call), writers, limits, response);
  stream->Begin();
  return stream.get();
}

}  // namespace bccskel::server
