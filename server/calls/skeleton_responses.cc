#include "server/calls/skeleton_responses.h"

#include <algorithm>

#include "proto/wire/result.h"
#include "server/calls/request_sequence.h"

namespace bccskel::server {
namespace {

constexpr size_t kThinVolumeChunkBytes = 256 * 1024;

v1::SkeletonSummary SummaryOf(const JobResult& result) {
  return wire::SummaryOf(result.skeleton, {.queued = result.queued,
                                           .decoded = result.decoded,
                                           .threads = result.threads,
                                           .thin_volume_size_bytes = result.thin_volume.size(),
                                           .algorithm_version = result.skeleton.algorithm_version,
                                           .method = result.skeleton.method});
}

}  // namespace

v1::SkeletonizeAccepted AcceptedFor(const std::string& job) {
  v1::SkeletonizeAccepted accepted;
  accepted.set_job(job);
  accepted.set_durable(false);
  accepted.set_max_chunk_bytes(kMaxChunkBytes);
  return accepted;
}

std::optional<v1::SkeletonizeResponse> ResultPieces::Next() {
  if (at_end_) return std::nullopt;
  v1::SkeletonizeResponse response;
  if (in_skeleton_) {
    if (auto chunk = pager_.Next(); chunk.has_value()) {
      *response.mutable_skeleton_chunk() = *std::move(chunk);
      return response;
    }
    in_skeleton_ = false;
  }
  const std::string& thin = result_.thin_volume;
  if (thin_volume_offset_ < thin.size()) {
    const size_t size = std::min(kThinVolumeChunkBytes, thin.size() - thin_volume_offset_);
    v1::ThinVolumeChunk& chunk = *response.mutable_thin_volume_chunk();
    chunk.set_offset(thin_volume_offset_);
    chunk.set_data(thin.data() + thin_volume_offset_, size);
    thin_volume_offset_ += size;
    return response;
  }
  at_end_ = true;
  *response.mutable_summary() = SummaryOf(result_);
  return response;
}

std::optional<v1::SkeletonizeResponse> SkeletonResponses::Next() {
  v1::SkeletonizeResponse response;
  if (accepted_.has_value()) {
    *response.mutable_accepted() = *std::exchange(accepted_, std::nullopt);
    return response;
  }
  if (progress_.has_value()) {
    *response.mutable_shell_progress() = *std::exchange(progress_, std::nullopt);
    return response;
  }
  if (!shell_points_.empty()) {
    response.mutable_shell_points()->ParseFromString(shell_points_.front());
    shell_points_.pop_front();
    return response;
  }
  return pieces_ != nullptr ? pieces_->Next() : std::nullopt;
}

ResultRecord RecordOf(const v1::SkeletonizeResponse& piece) {
  using Kind = ResultRecord::Kind;
  if (piece.has_skeleton_chunk()) {
    return {Kind::kSkeletonChunk, piece.skeleton_chunk().SerializeAsString()};
  }
  if (piece.has_thin_volume_chunk()) {
    return {Kind::kThinVolumeChunk, piece.thin_volume_chunk().SerializeAsString()};
  }
  return {Kind::kSummary, piece.summary().SerializeAsString()};
}

}  // namespace bccskel::server
