#include "server/calls/result_stream.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/durable/ledger.h"
#include "server/calls/durable_messages.h"
#include "server/calls/lasting_calls.h"
#include "server/calls/status_mapping.h"
#include "server/calls/refused_call.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using Reactor = grpc::ServerWriteReactor<v1::ReadSkeletonResponse>;

// A ReadSkeleton call: reads a record, writes it, reads the next. So a slow reader costs one
// record.
class ResultStream final : public Reactor,
                           public LastingCall,
                           public std::enable_shared_from_this<ResultStream> {
 public:
  ResultStream(DurableCall call, const v1::ReadSkeletonRequest& request)
      : call_(std::move(call)), job_(request.job()), piece_(request.piece_index()) {}

  void Begin() {
    self_ = shared_from_this();
    using Reader = std::shared_ptr<ResultReader>;
    call_.ledger.OpenResult(call_.tenant(), job_, piece_,
                            [self = self_](absl::StatusOr<Reader> reader) {
                              if (!reader.ok()) return self->End(reader.status());
                              self->reader_ = *std::move(reader);
                              self->ReadNext();
                            });
    call_.facts.LookAfter(self_);
  }

  void EndEarly(const absl::Status& why) override { End(why); }

  void OnWriteDone(bool ok) override {
    if (!ok) return End(absl::CancelledError("the caller is gone"));
    ReadNext();
  }
  void OnCancel() override { End(call_.facts.CancelStatus()); }
  void OnDone() override;

 private:
  void ReadNext();
  absl::Status Write(const ResultRecord& record);
  absl::Status EndOfResult() const;
  void End(const absl::Status& status);

  const DurableCall call_;
  const std::string job_;
  std::shared_ptr<ResultStream> self_;

  // Used by one reaction at a time.
  std::shared_ptr<ResultReader> reader_;
  v1::ReadSkeletonResponse response_;
  uint32_t piece_;
  bool first_ = true;
  bool complete_ = false;  // the summary was written

  std::mutex mutex_;
  std::optional<absl::Status> end_;  // guarded by mutex_
};

void ResultStream::ReadNext() {
  reader_->Next([self = shared_from_this()](absl::StatusOr<std::optional<ResultRecord>> record) {
    if (!record.ok()) return self->End(record.status());
    if (!record->has_value()) return self->End(self->EndOfResult());
    if (absl::Status written = self->Write(**record); !written.ok()) self->End(written);
  });
}

absl::Status ResultStream::Write(const ResultRecord& record) {
  BCCSKEL_ASSIGN_OR_RETURN(response_, ToMessage(record, piece_));
  ++piece_;
  complete_ = response_.has_summary();
  grpc::WriteOptions options;
  // More follows at once. But the first message goes with the initial metadata, and gRPC 1.51 tells
  // that those are written only when they are: with the hint they wait for what never comes.
  if (!complete_ && !first_) options.set_buffer_hint();
  first_ = false;
  std::lock_guard lock(mutex_);
  if (!end_.has_value()) StartWrite(&response_, options);
  return absl::OkStatus();
}

// Who asks for the piece after the last one has miscounted.
absl::Status ResultStream::EndOfResult() const {
  if (complete_) return absl::OkStatus();
  return CallError(Reason::kPieceIndex, absl::StrCat(job_, " has ", piece_, " pieces"), {.key = "pieces", .value = absl::StrCat(piece_)});
}

void ResultStream::End(const absl::Status& status) {
  std::lock_guard lock(mutex_);
  if (end_.has_value()) return;
  end_ = StorageError(status);
  Finish(ToGrpcStatus(*end_));
}

void ResultStream::OnDone() {
  const std::shared_ptr<ResultStream> self = std::move(self_);
  call_.facts.Leave(*this);
  std::lock_guard lock(mutex_);
  call_.facts.LogEnded(job_, *end_);
}

}  // namespace

grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* StartResultStream(
    absl::StatusOr<DurableCall> call, const v1::ReadSkeletonRequest& request) {
  if (!call.ok()) return new RefusedCall<Reactor>(call.status());
  const auto stream = std::make_shared<ResultStream>(*std::move(call), request);
  stream->Begin();
  return stream.get();
}

}  // namespace bccskel::server
