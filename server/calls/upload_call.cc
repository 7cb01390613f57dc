#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/calls/durable_messages.h"
#include "server/calls/message_codec.h"
#include "server/calls/requests.h"
#include "server/calls/services.h"
#include "server/calls/stream_call.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using UploadBase = ReceivingCall<StreamCall<grpc::ServerReadReactor<v1::UploadVolumeRequest>>,
                                 v1::UploadVolumeRequest>;

// An UploadVolume call: passes one chunk at a time to DurableJobs and reads the next when
// DurableJobs has room.
class UploadCall final : public UploadBase, public UploadWriters::Writer {
  // Makes a callback for DurableJobs that calls `next` with the value or ends the call with the
  // error.
  template <typename Next>
  auto Then(Next next) {
    return [self = Self(), next = std::move(next)](auto value) {
      if (!value.ok()) return self->End(StorageError(value.status()));
      next(*self, *value);
    };
  }
  std::shared_ptr<UploadCall> Self() {
    return std::static_pointer_cast<UploadCall>(shared_from_this());
  }

 public:
  UploadCall(DurableCall call, UploadWriters& writers, const JobPool::Limits& limits,
             v1::UploadVolumeResponse& response)
      : UploadBase(std::move(call.facts)),
        durable_jobs_(call.durable_jobs),
        writers_(writers),
        limits_(limits),
        response_(response) {}
  // Runs when no call of DurableJobs is in progress, so that the next writer may begin.
  ~UploadCall() override {
    if (open_ && !sequence_.finished()) durable_jobs_.SenderGone(facts_.tenant, upload_);
  }

  void Begin() {
    Read();
    Open();
  }

  void OnTurn(UploadWriters::Turn turn) override {
    turn_ = std::move(turn);
    durable_jobs_.GetUpload(
        facts_.tenant, upload_, [self = Self()](absl::StatusOr<UploadInfo> upload) {
          if (absl::IsNotFound(upload.status())) return self->Create();
          self->Then([](UploadCall& it, const UploadInfo& found) { it.Resume(found); })(
              std::move(upload));
        });
  }
  void OnTakenOver() override {
    End(CallError(Reason::kSecondWriter, absl::StrCat("another stream has taken over ", upload_)));
  }

 private:
  absl::Status CheckWanted(const v1::UploadVolumeRequest& request) override {
    if (!complete_ || !request.has_chunk()) return absl::OkStatus();
    return CallError(Reason::kUploadFinished,
                     absl::StrCat(upload_, " is finished and accepts no more chunks"));
  }

  absl::Status Take(v1::UploadVolumeRequest& request) override {
    if (request.has_config()) return TakeConfig(request.config());
    if (request.has_chunk()) {
      v1::VolumeChunk& chunk = *request.mutable_chunk();
      const std::optional<uint32_t> crc32c = Crc32cOf(chunk);
      durable_jobs_.Append(facts_.tenant, upload_, chunk.offset(), std::move(*chunk.mutable_data()),
                           crc32c, Then([](UploadCall& it, uint64_t) { it.Read(); }));
    } else {
      const v1::VolumeFinish& finish = request.finish();
      durable_jobs_.FinishUpload(facts_.tenant, upload_, finish.size_bytes(), DigestOf(finish),
                                 Then([](UploadCall& it, const VolumeInfo& volume) {
                                   it.AnswerStatus(absl::HexStringToBytes(volume.blob_digest));
                                 }));
    }
    return absl::OkStatus();
  }
  void TakeHalfClose(const absl::Status& status) override {
    return open_ ? AnswerStatus("") : End(status);
  }

  absl::Status TakeConfig(const v1::UploadVolumeConfig& config) {
    if (config.upload().empty()) return InvalidField("config.upload", "must be set");
    v1::SkeletonizeConfig whole;
    *whole.mutable_volume() = config.volume();
    BCCSKEL_RETURN_IF_ERROR(JobRequestOf(whole, limits_.volume).status());
    BCCSKEL_RETURN_IF_ERROR(limits_.CheckVolumeBytes(config.volume().size_bytes()));
    upload_ = config.upload();
    declaration_ = DeclarationBytes(config.volume());
    {
      std::lock_guard lock(mutex_);
      subject_ = upload_;
    }
    writers_.Claim({facts_.tenant, upload_}, Self());
    return absl::OkStatus();
  }
  void Create() {
    NewUpload upload;
    upload.name = upload_;
    upload.declaration = declaration_;
    durable_jobs_.CreateUpload(
        facts_.tenant, upload,
        Then([](UploadCall& it, const UploadInfo& info) { it.Resume(info); }));
  }

  void Resume(const UploadInfo& upload) {
    if (upload.declaration != declaration_) {
      return End(CallError(Reason::kUploadExists,
                           absl::StrCat(upload_, " was started with another declaration")));
    }
    open_ = true;
    complete_ = !upload.volume.empty();
    sequence_.ResumeAt(upload.committed_bytes);
    Read();
  }

  // Answers with the state of the upload and ends the call.
  void AnswerStatus(const std::string& blob_digest) {
    durable_jobs_.GetUpload(facts_.tenant, upload_,
                            Then([blob_digest](UploadCall& it, const UploadInfo& upload) {
                              {
                                std::lock_guard lock(it.mutex_);
                                if (it.end_.has_value()) return;
                                *it.response_.mutable_upload() = ToMessage(upload);
                                it.response_.set_blob_sha256(blob_digest);
                              }
                              it.End(absl::OkStatus());
                            }));
  }
  DurableJobs& durable_jobs_;
  UploadWriters& writers_;
  const JobPool::Limits limits_;
  // Used by one reaction at a time.
  UploadWriters::Turn turn_;
  std::string upload_;
  std::string declaration_;
  bool open_ = false;
  bool complete_ = false;               // before this call
  v1::UploadVolumeResponse& response_;  // guarded by mutex_; dangling once end_ is set
};

}  // namespace

grpc::ServerReadReactor<v1::UploadVolumeRequest>* StartUpload(absl::StatusOr<DurableCall> call,
                                                              UploadWriters& writers,
                                                              const JobPool::Limits& limits,
                                                              v1::UploadVolumeResponse& response) {
  return StartCall<UploadCall>(std::move(call), writers, limits, response);
}

}  // namespace bccskel::server
