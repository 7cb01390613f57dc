#include "client/labels_call.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/labels/convert_label.h"
#include "proto/wire/labels.h"
#include "proto/wire/options.h"
#include "proto/wire/placement.h"

namespace bccskel::client {
namespace {

// 0 would mean no promise.
uint64_t AtLeastOne(uint64_t count) { return std::max(count, uint64_t{1}); }

void Declare(const EncodedLabels& volume, v1::LabelVolumeDeclaration& declaration) {
  const MaskGrid& grid = volume.grid;
  declaration.set_type(wire::LabelTypeOf(volume.label_bytes));
  declaration.set_compression(v1::VOLUME_COMPRESSION_ZSTD);
  *declaration.mutable_extent() =
      wire::ToMessage(LatticeExtent{.nx = grid.nx, .ny = grid.ny, .nz = grid.nz});
  *declaration.mutable_placement() = wire::ToMessage(grid.placement);
  declaration.set_size_bytes(volume.bytes.size());
  declaration.set_max_voxels(AtLeastOne(volume.voxels));
  declaration.set_max_label_voxels(AtLeastOne(volume.largest_voxels));
  declaration.set_max_runs(AtLeastOne(volume.runs));
  declaration.set_max_labels(AtLeastOne(volume.labels));
}

v1::SkeletonizeLabelsRequest ConfigRequest(const EncodedLabels& volume,
                                           const LabelsCallOptions& options) {
  v1::SkeletonizeLabelsRequest request;
  v1::SkeletonizeLabelsConfig& config = *request.mutable_config();
  Declare(volume, *config.mutable_volume());
  config.mutable_volume()->set_mask_adjacency(options.adjacency == MaskAdjacency::k26
                                                  ? v1::MASK_ADJACENCY_OBJECT_26
                                                  : v1::MASK_ADJACENCY_OBJECT_6);
  config.mutable_volume()->set_voxel_points(
      options.points == VoxelPoints::kTwo ? v1::VOXEL_POINTS_TWO : v1::VOXEL_POINTS_SIXTEEN);
  config.mutable_labels()->Add(options.labels.begin(), options.labels.end());
  config.set_min_voxels(options.min_voxels);
  SkeletonizeOptions skeletonize = options.skeletonize;
  skeletonize.preparing =
      PreparingForMask(skeletonize.preparing, volume.grid, {.points = options.points});
  *config.mutable_options() = wire::ToMessage(skeletonize);
  config.set_threads(options.threads);
  return request;
}

}  // namespace

absl::StatusOr<LabelsReport> LabelsCall::Run(const EncodedLabels& volume) {
  BCCSKEL_RETURN_IF_ERROR(Converse(ConfigRequest(volume, options_), volume.bytes));
  if (!summary_.has_value())
    return absl::DataLossError("the server ended the call without a summary");
  if (summary_->labels() != labels_) {
    return absl::DataLossError(
        absl::StrCat("received ", labels_, " labels, the summary states ", summary_->labels()));
  }
  return LabelsReport{
      .labels = labels_, .skipped = summary_->skipped(), .absent = summary_->absent()};
}

absl::Status LabelsCall::Take(v1::SkeletonizeLabelsResponse& response) {
  using Response = v1::SkeletonizeLabelsResponse;
  switch (response.response_case()) {
    case Response::kLabelProgress:
      if (options_.on_progress) {
        options_.on_progress(response.label_progress().done(), response.label_progress().total());
      }
      return absl::OkStatus();
    case Response::kSkeletonChunk:
      return TakeChunk(response.skeleton_chunk());
    case Response::kLabelSummary:
      return TakeLabel(response.label_summary());
    case Response::kLabelsSummary:
      summary_ = std::move(*response.mutable_labels_summary());
      return absl::OkStatus();
    case Response::kAccepted:
      return absl::DataLossError("the server accepted the job twice");
    case Response::RESPONSE_NOT_SET:
      return absl::OkStatus();  // a kind of event that this version does not know
  }
  return absl::OkStatus();
}

absl::Status LabelsCall::TakeChunk(const v1::LabelSkeletonChunk& chunk) {
  if (label_.value_or(chunk.label()) != chunk.label()) {
    return absl::DataLossError(absl::StrCat("a piece of label ", chunk.label(),
                                            " came before the end of label ", *label_));
  }
  label_ = chunk.label();
  return assembler_.Add(chunk.chunk());
}

absl::Status LabelsCall::TakeLabel(const v1::LabelSummary& summary) {
  if (label_ != summary.label() || (labels_ > 0 && summary.label() <= last_label_)) {
    return absl::DataLossError(absl::StrCat("label ", summary.label(), " came out of order"));
  }
  LabelSkeleton skeleton;
  skeleton.label = last_label_ = summary.label();
  skeleton.voxels = summary.voxels();
  BCCSKEL_ASSIGN_OR_RETURN(
      skeleton.result,
      std::exchange(assembler_, wire::SkeletonAssembler()).Finish(summary.summary()));
  label_.reset();
  ++labels_;
  return consume_(std::move(skeleton));
}

}  // namespace bccskel::client
