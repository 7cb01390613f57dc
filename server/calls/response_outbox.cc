#include "server/calls/response_outbox.h"

#include <algorithm>
#include <utility>

#include "core/pipeline/algorithm_version.h"
#include "proto/wire/result.h"
#include "server/calls/request_sequence.h"

namespace bccskel::server {
namespace {

constexpr size_t kThinVolumeChunkBytes = 256 * 1024;

}  // namespace

v1::SkeletonizeAccepted AcceptedFor(const std::string& job) {
  v1::SkeletonizeAccepted accepted;
  accepted.set_job(job);
  accepted.set_durable(false);
  accepted.set_max_chunk_bytes(kMaxChunkBytes);
  return accepted;
}

void ResponseOutbox::Complete(JobResult result) {
  result_ = std::move(result);
  pager_.emplace(result_.skeleton.graph);
  stage_ = Stage::kSkeleton;
}

std::optional<v1::SkeletonizeResponse> ResponseOutbox::Next() {
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
  return NextOfResult();
}

std::optional<v1::SkeletonizeResponse> ResponseOutbox::NextOfResult() {
  if (stage_ == Stage::kSkeleton) {
    if (auto chunk = pager_->Next(); chunk.has_value()) {
      v1::SkeletonizeResponse response;
      *response.mutable_skeleton_chunk() = *std::move(chunk);
      return response;
    }
    stage_ = Stage::kThinVolume;
  }
  if (stage_ == Stage::kThinVolume) {
    if (thin_volume_offset_ < result_.thin_volume.size()) return NextThinVolumeChunk();
    stage_ = Stage::kSummary;
  }
  if (stage_ != Stage::kSummary) return std::nullopt;
  stage_ = Stage::kEnd;
  return Summary();
}

v1::SkeletonizeResponse ResponseOutbox::NextThinVolumeChunk() {
  const size_t left = result_.thin_volume.size() - thin_volume_offset_;
  const size_t size = std::min(kThinVolumeChunkBytes, left);
  v1::SkeletonizeResponse response;
  v1::ThinVolumeChunk& chunk = *response.mutable_thin_volume_chunk();
  chunk.set_offset(thin_volume_offset_);
  chunk.set_data(result_.thin_volume.data() + thin_volume_offset_, size);
  thin_volume_offset_ += size;
  return response;
}

v1::SkeletonizeResponse ResponseOutbox::Summary() const {
  const wire::JobFacts facts = {
      .queued = result_.queued,
      .decoded = result_.decoded,
      .threads = result_.threads,
      .thin_volume_size_bytes = result_.thin_volume.size(),
      .algorithm_version = AlgorithmVersionOf(result_.skeleton.options.source),
      .method = result_.skeleton.method};
  v1::SkeletonizeResponse response;
  *response.mutable_summary() = wire::SummaryOf(result_.skeleton, facts);
  return response;
}

}  // namespace bccskel::server
