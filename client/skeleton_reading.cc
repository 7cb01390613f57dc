#include "client/skeleton_reading.h"

#include <utility>

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

absl::StatusOr<SkeletonizeResult> SkeletonReading::Finish() && {
  if (!summary_.has_value()) return absl::DataLossError("the server ended without a summary");
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
