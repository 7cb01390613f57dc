#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/calls/services.h"
#include "server/calls/skeleton_responses.h"
#include "server/calls/stream_call.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using ReadBase = WritingCall<StreamCall<grpc::ServerWriteReactor<v1::ReadSkeletonResponse>>,
                             v1::ReadSkeletonResponse>;

// A ReadSkeleton call: reads a record, writes it, reads the next. So a slow reader costs the memory
// of one record.
class ReadCall final : public ReadBase {
 public:
  ReadCall(DurableCall call, const v1::ReadSkeletonRequest& request)
      : ReadBase(std::move(call.facts)),
        durable_jobs_(call.durable_jobs),
        index_(request.piece_index()) {
    subject_ = request.job();
  }

  void Begin() {
    using Reader = std::shared_ptr<ResultReader>;
    Open();
    durable_jobs_.OpenResult(facts_.tenant, subject_, index_,
                             [self = Self()](absl::StatusOr<Reader> reader) {
                               if (!reader.ok()) return self->End(StorageError(reader.status()));
                               self->reader_ = *std::move(reader);
                               self->Fetch();
                             });
  }

 private:
  void Fetch() override {
    reader_->Next([self = Self()](absl::StatusOr<std::optional<ResultRecord>> record) {
      absl::Status status = record.status();
      if (status.ok() && !record->has_value()) return self->End(self->EndOfResult());
      if (status.ok()) status = self->Take(**std::move(record));
      if (!status.ok()) self->End(StorageError(status));
    });
  }

  absl::Status Take(ResultRecord record) {
    v1::ReadSkeletonResponse piece;
    piece.set_piece_index(index_);
    BCCSKEL_RETURN_IF_ERROR(SetPiece(std::move(record), piece));
    ++index_;
    complete_ = piece.has_summary();
    std::lock_guard lock(mutex_);
    piece_ = std::move(piece);
    Advance();
    return absl::OkStatus();
  }
  // Errors: PIECE_INDEX for a first piece beyond the summary.
  absl::Status EndOfResult() const {
    if (complete_) return absl::OkStatus();
    return CallError(Reason::kPieceIndex, absl::StrCat(subject_, " has ", index_, " pieces"),
                     {.key = "pieces", .value = absl::StrCat(index_)});
  }
  std::optional<v1::ReadSkeletonResponse> Next() override {
    return std::exchange(piece_, std::nullopt);
  }
  Following Follows(const v1::ReadSkeletonResponse& response) const override {
    return response.has_summary() ? Following::kFetched : Following::kFetchedAtOnce;
  }
  std::shared_ptr<ReadCall> Self() {
    return std::static_pointer_cast<ReadCall>(shared_from_this());
  }

  DurableJobs& durable_jobs_;
  // Used by one reaction at a time.
  std::shared_ptr<ResultReader> reader_;
  uint32_t index_;
  bool complete_ = false;                          // the summary was read
  std::optional<v1::ReadSkeletonResponse> piece_;  // guarded by mutex_
};

}  // namespace

grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* StartRead(
    absl::StatusOr<DurableCall> call, const v1::ReadSkeletonRequest& request) {
  return StartCall<ReadCall>(std::move(call), request);
}

}  // namespace bccskel::server
