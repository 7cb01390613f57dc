#include "client/skeleton_reading.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_decoder.h"

namespace bccskel::client {

absl::Status SkeletonReading::Add(const v1::SkeletonChunk& chunk) {
  ++pieces_;
  return assembler_.Add(chunk);
}

absl::Status SkeletonReading::Add(const v1::ThinVolumeChunk& chunk) {
  if (chunk.offset() != thin_bytes_.size()) {
    return absl::DataLossError("a piece of the thinned volume is missing");
  }
  ++pieces_;
  thin_bytes_ += chunk.data();
  return absl::OkStatus();
}

absl::Status SkeletonReading::Add(v1::SkeletonSummary summary) {
  ++pieces_;
  summary_ = std::move(summary);
  return absl::OkStatus();
}

absl::Status SkeletonReading::Add(v1::ReadSkeletonResponse& piece) {
  if (piece.piece_index() != pieces_) {
    return absl::DataLossError(
        absl::StrCat("piece ", piece.piece_index(), " came instead of ", pieces_));
  }
  switch (piece.piece_case()) {
    case v1::ReadSkeletonResponse::kSkeletonChunk:
      return Add(piece.skeleton_chunk());
    case v1::ReadSkeletonResponse::kThinVolumeChunk:
      return Add(piece.thin_volume_chunk());
    case v1::ReadSkeletonResponse::kSummary:
      return Add(std::move(*piece.mutable_summary()));
    case v1::ReadSkeletonResponse::PIECE_NOT_SET:
      break;
  }
  return absl::DataLossError("a piece of a kind that this version does not know");
}

absl::StatusOr<SkeletonizeResult> SkeletonReading::Finish() && {
  if (!summary_.has_value())
    return absl::DataLossError("the server ended the call without a summary");
  BCCSKEL_ASSIGN_OR_RETURN(SkeletonizeResult result, std::move(assembler_).Finish(*summary_));
  if (thin_bytes_.empty()) return result;
  absl::StatusOr<Volume> thin = DecodeVolume(VolumeEncoding::kBricks, thin_bytes_);
  if (!thin.ok()) {
    return absl::DataLossError("the thinned volume is damaged: " +
                               std::string(thin.status().message()));
  }
  result.thin = *std::move(thin);
  return result;
}

}  // namespace bccskel::client
