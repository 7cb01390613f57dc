#include "core/labels/edge_image.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <unordered_map>
#include <utility>

#include "core/exec/status_macros.h"
#include "core/labels/curve_points.h"
#include "core/labels/point_index.h"
#include "core/labels/run_lookup.h"

namespace bccskel {
namespace {

constexpr size_t kRunsPerBatch = 512;

// Adds a voxel behind the last one of its row or starts a run.
void Append(SparseImage& image, const VoxelRun& voxel, uint32_t value) {
  if (!image.empty()) {
    VoxelRun& last = image.back().voxels;
    if (image.back().value == value && last.z == voxel.z && last.y == voxel.y &&
        last.end == voxel.begin) {
      last.end = voxel.end;
      return;
    }
  }
  image.push_back({voxel, value});
}

// Whether the voxels are the same or neighbors (26).
bool Touch(const std::array<int32_t, 3>& a, const std::array<int32_t, 3>& b) {
  return std::abs(a[0] - b[0]) <= 1 && std::abs(a[1] - b[1]) <= 1 && std::abs(a[2] - b[2]) <= 1;
}

// The curve points of each component, ready to be searched.
class ComponentPoints {
 public:
  ComponentPoints(const std::vector<CurvePoint>& points, const std::vector<RunIndex>& components,
                  const std::array<double, 3>& spacing)
      : components_(components) {
    std::unordered_map<RunIndex, std::vector<ValuePoint>> groups;
    for (const CurvePoint& p : points) {
      ValuePoint point{p.at, p.value};
      for (size_t axis = 0; axis < 3; ++axis) point.at[axis] *= spacing[axis];
      groups[components[p.run]].push_back(point);
    }
    for (auto& [component, group] : groups) indices_.try_emplace(component, std::move(group));
  }

  // Null when the run's component has none.
  const PointIndex* Of(RunIndex run) const {
    const auto found = indices_.find(components_[run]);
    return found == indices_.end() ? nullptr : &found->second;
  }

 private:
  const std::vector<RunIndex>& components_;
  std::unordered_map<RunIndex, PointIndex> indices_;
};

// Labels the runs of an object batch by batch; several workers share one.
class NearestEdgeWork {
 public:
  NearestEdgeWork(const MaskGrid& grid, const LabeledObject& object, const ComponentPoints& points,
                  const exec::Context& context)
      : spacing_(grid.placement.spacing),
        runs_(object.runs),
        points_(points),
        context_(context),
        images_((object.runs.size() + kRunsPerBatch - 1) / kRunsPerBatch) {}

  void Work() {
    for (size_t n = next_++; n < images_.size() && !context_.ShouldStop(); n = next_++) {
      const size_t end = std::min((n + 1) * kRunsPerBatch, runs_.size());
      Hint hint;
      for (RunIndex run = n * kRunsPerBatch; run < end; ++run) LabelRun(run, hint, images_[n]);
    }
  }

  // Needs: every worker is back.
  SparseImage Finish() {
    SparseImage all;
    for (const SparseImage& image : images_) all.insert(all.end(), image.begin(), image.end());
    return all;
  }

 private:
  // The last answer and where it was found.
  struct Hint {
    const PointIndex* index = nullptr;
    size_t point = 0;
  };

  void LabelRun(RunIndex n, Hint& hint, SparseImage& image) const {
    const PointIndex* const index = points_.Of(n);
    if (index == nullptr) return;
    if (index != hint.index) hint = {index, 0};
    const VoxelRun& run = runs_[n];
    std::array<double, 3> at = {0, run.y * spacing_[1], run.z * spacing_[2]};
    for (int32_t x = run.begin; x < run.end; ++x) {
      at[0] = x * spacing_[0];
      const NearestCurvePoint nearest = index->Find(at, hint.point);
      hint.point = nearest.point;
      Append(image, {run.z, run.y, x, x + 1}, nearest.value);
    }
  }

  const std::array<double, 3> spacing_;
  const std::vector<VoxelRun>& runs_;
  const ComponentPoints& points_;
  const exec::Context& context_;
  std::vector<SparseImage> images_;
  std::atomic<size_t> next_{0};
};

}  // namespace

absl::StatusOr<SparseImage> NearestEdges(const MaskGrid& grid, const LabeledObject& object,
                                         const SkeletonGraph& graph, MaskAdjacency adjacency,
                                         const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<CurvePoint> curve,
                           CurvePointsOf(graph, grid, RunLookup(object.runs)));
  const std::vector<RunIndex> components = ComponentsOfRuns(object.runs, adjacency);
  const ComponentPoints points(curve, components, grid.placement.spacing);
  NearestEdgeWork work(grid, object, points, context);
  context.Offer([&work](int) { work.Work(); });
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  return work.Finish();
}

absl::StatusOr<SparseImage> DrawSkeleton(const MaskGrid& grid, const LabeledObject& object,
                                         const SkeletonGraph& graph) {
  const RunLookup lookup(object.runs);
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<CurvePoint> points,
                           CurvePointsOf(graph, grid, lookup));
  SparseImage voxels;
  const auto draw = [&](const std::array<int32_t, 3>& voxel, uint32_t value) {
    const auto [x, y, z] = voxel;
    voxels.push_back({{z, y, x, x + 1}, value});
  };
  for (size_t n = 0; n < points.size(); ++n) {
    const CurvePoint& p = points[n];
    draw(p.voxel, p.value);
    if (n == 0 || points[n - 1].value != p.value || Touch(points[n - 1].voxel, p.voxel)) continue;
    if (const auto between = SharedVoxel(points[n - 1], p, lookup)) draw(*between, p.value);
  }
  std::ranges::sort(voxels);
  SparseImage image;
  const VoxelRun* before = nullptr;
  for (const auto& [voxel, value] : voxels) {
    if (before == nullptr || *before != voxel) Append(image, voxel, value);
    before = &voxel;
  }
  return image;
}

}  // namespace bccskel
