#include "client/python/native/edge_images.h"

#include <memory>
#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/labels/curve_points.h"
#include "core/labels/label_collector.h"

namespace bccskel::python {
namespace {

absl::Status CheckVoxels(const Outcome& outcome) {
  if (outcome.read.has_value()) {
    return absl::InvalidArgumentError(
        "a result read from a file does not contain the voxels; compute it again from the mask");
  }
  if (!outcome.grid.has_value()) return absl::InvalidArgumentError("a mesh has no voxels to draw");
  if (outcome.mask.sampling.has_value()) {
    return absl::InvalidArgumentError("a sampling has no voxels of its own to draw");
  }
  if (!outcome.result.preparing.empty()) {
    return absl::InvalidArgumentError(
        "images show the original voxels and cannot be combined with what changes them: denoise, "
        "fill_cavities, join_gaps, cut_loops, min_component, min_component_volume, keep_largest, "
        "or a preset other than cad");
  }
  if (outcome.object != nullptr || outcome.label != nullptr) return absl::OkStatus();
  return absl::UnimplementedError("for a label that a server has computed, use image == label");
}

// In an exact conversion the odd points are the centers of the parts of voxels.
absl::StatusOr<LabeledObject> VoxelsOf(const Volume& object, const MaskGrid& grid,
                                       VoxelPoints points, const exec::Context& context) {
  const VoxelParts parts = PartsOf(grid, points);
  std::vector<uint64_t> words(grid.WordsPerSlice() * static_cast<size_t>(grid.nz));
  object.ForEachPoint([&](LatticePoint p) {
    if (SublatticeOf(p) == Sublattice::kEven) return;
    const auto x = static_cast<size_t>(p.x / (2 * parts[0]));
    const size_t row = static_cast<size_t>(p.z / (2 * parts[2])) * static_cast<size_t>(grid.ny) +
                       static_cast<size_t>(p.y / (2 * parts[1]));
    words[row * grid.WordsPerRow() + x / 64] |= uint64_t{1} << (x % 64);
  });
  BCCSKEL_ASSIGN_OR_RETURN(LabelCollector collector, LabelCollector::Create(grid, {}));
  for (size_t z = 0; z < static_cast<size_t>(grid.nz); ++z) {
    const std::span slice =
        std::span(words).subspan(z * grid.WordsPerSlice(), grid.WordsPerSlice());
    BCCSKEL_RETURN_IF_ERROR(collector.AddMaskSlice(slice, context));
  }
  BCCSKEL_ASSIGN_OR_RETURN(LabeledObjects objects, std::move(collector).Finish());
  return objects.objects.empty() ? LabeledObject() : std::move(objects.objects.front());
}

// Needs: a grid.
absl::StatusOr<std::shared_ptr<const LabeledObject>> KnownVoxels(const Outcome& outcome,
                                                                 const exec::Context& context) {
  if (outcome.label != nullptr) return outcome.label;
  if (outcome.object == nullptr || outcome.mask.sampling.has_value()) {
    return std::make_shared<const LabeledObject>();
  }
  BCCSKEL_ASSIGN_OR_RETURN(LabeledObject found,
                           VoxelsOf(*outcome.object, *outcome.grid, outcome.mask.points, context));
  return std::make_shared<const LabeledObject>(std::move(found));
}

}  // namespace

absl::StatusOr<SparseImage> ImageOf(const Outcome& outcome, EdgeImage kind,
                                    const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckVoxels(outcome));
  const MaskGrid& grid = *outcome.grid;
  BCCSKEL_ASSIGN_OR_RETURN(const std::shared_ptr<const LabeledObject> voxels,
                           KnownVoxels(outcome, context));
  if (voxels->runs.empty()) return SparseImage();
  const SkeletonGraph& graph = outcome.result.graph;
  if (kind == EdgeImage::kCurves) return DrawSkeleton(grid, *voxels, graph);
  return NearestEdges(grid, *voxels, graph, outcome.mask.adjacency, context);
}

absl::StatusOr<std::vector<std::array<int32_t, 3>>> VoxelsOfNodes(const Outcome& outcome,
                                                                  const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::shared_ptr<const LabeledObject> voxels,
                           KnownVoxels(outcome, context));
  return NodeVoxels(outcome.result.graph, *outcome.grid, RunLookup(voxels->runs));
}

}  // namespace bccskel::python
