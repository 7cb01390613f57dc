#include "server/calls/label_responses.h"

#include "core/pipeline/algorithm_version.h"
#include "proto/wire/duration.h"
#include "proto/wire/result.h"

namespace bccskel::server {
namespace {

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

std::optional<v1::SkeletonizeLabelsResponse> LabelResponses::Next() {
  v1::SkeletonizeLabelsResponse response;
  if (accepted_.has_value()) {
    *response.mutable_accepted() = *std::exchange(accepted_, std::nullopt);
    return response;
  }
  if (progress_.has_value()) {
    *response.mutable_label_progress() = *std::exchange(progress_, std::nullopt);
    return response;
  }
  if (!labels_.empty()) return NextOfLabel();
  if (!result_.has_value() || at_end_) return std::nullopt;
  at_end_ = true;
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

}  // namespace bccskel::server
