#include "server/calls/skeleton_responses.h"

#include <algorithm>

#include "core/pipeline/algorithm_version.h"
#include "proto/wire/duration.h"
#include "proto/wire/result.h"

namespace bccskel::server {
namespace {

constexpr size_t kThinVolumeChunkBytes = 256 * 1024;

v1::SkeletonSummary SummaryOf(const JobResult& result) {
  return wire::SummaryOf(result.skeleton, {.queued = result.times.queued,
                                           .decoded = result.times.decoded,
                                           .threads = result.threads,
                                           .thin_volume_size_bytes = result.thin_volume.size(),
                                           .algorithm_version = result.skeleton.algorithm_version,
                                           .method = result.skeleton.method});
}

v1::LabelsSummary SummaryOf(const LabelsResult& result) {
  v1::LabelsSummary summary;
  summary.set_labels(result.labels);
  summary.set_skipped(result.skipped);
  summary.set_absent(result.absent);
  summary.set_voxels(result.voxels);
  summary.set_object_points(result.object_points);
  summary.set_skeleton_points(result.skeleton_points);
  *summary.mutable_timings()->mutable_queue() = wire::DurationMessage(result.times.queued);
  *summary.mutable_timings()->mutable_decode() = wire::DurationMessage(result.times.decoded);
  *summary.mutable_timings()->mutable_compute() = wire::DurationMessage(result.times.computed);
  summary.set_algorithm_version(kAlgorithmVersion);
  summary.set_threads(result.threads);
  return summary;
}

}  // namespace

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
  if (HasFirst()) return NextFirst();
  if (!shell_points_.empty()) {
    v1::SkeletonizeResponse response;
    response.mutable_shell_points()->ParseFromString(shell_points_.front());
    shell_points_.pop_front();
    return response;
  }
  return pieces_ != nullptr ? pieces_->Next() : std::nullopt;
}

std::optional<v1::SkeletonizeLabelsResponse> LabelResponses::Next() {
  if (HasFirst()) return NextFirst();
  if (!labels_.empty()) return NextOfLabel();
  if (!result_.has_value() || at_end_) return std::nullopt;
  at_end_ = true;
  v1::SkeletonizeLabelsResponse response;
  *response.mutable_labels_summary() = SummaryOf(*result_);
  return response;
}

v1::SkeletonizeLabelsResponse LabelResponses::NextOfLabel() {
  const LabelSkeleton& skeleton = labels_.front().skeleton;
  if (!pager_.has_value()) pager_.emplace(skeleton.result.graph);
  auto chunk = pager_->Next();
  if (!chunk.has_value()) return TakeSummary();
  v1::SkeletonizeLabelsResponse response;
  response.mutable_skeleton_chunk()->set_label(skeleton.label);
  *response.mutable_skeleton_chunk()->mutable_chunk() = *std::move(chunk);
  return response;
}

v1::SkeletonizeLabelsResponse LabelResponses::TakeSummary() {
  const LabelResult& label = labels_.front();
  const wire::JobFacts facts = {
      .threads = label.threads,
      .algorithm_version = AlgorithmVersionOf(label.skeleton.result.options.source),
      .method = label.skeleton.result.method};
  v1::SkeletonizeLabelsResponse response;
  v1::LabelSummary& summary = *response.mutable_label_summary();
  summary.set_label(label.skeleton.label);
  summary.set_voxels(label.skeleton.voxels);
  *summary.mutable_summary() = wire::SummaryOf(label.skeleton.result, facts);
  pager_.reset();
  labels_.pop_front();
  return response;
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
