#include "core/pipeline/at_border.h"

#include <unordered_map>
#include <unordered_set>

#include "core/distance/exact_radius.h"
#include "core/exec/status_macros.h"
#include "core/lattice/lattice_point_hash.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/prepare/beyond_border.h"
#include "core/skeleton/voxel_radii.h"

namespace bccskel {

BorderPoints LastPointsOf(ObjectSource source) {
  // The lattice of an exact conversion has the corners of the image's last voxels, and a cell of
  // points beyond them.
  return IsConverted(source) ? BorderPoints::kLastCorners : BorderPoints::kLastOfLattice;
}

std::optional<LatticeBox> ImageThatCuts(const LatticeExtent& extent,
                                        const SkeletonizeOptions& options) {
  const bool continues = options.border == Border::kContinues;
  if (!continues && !IsConverted(options.source)) return std::nullopt;
  AxesAcross axes = kAllAxes;
  if (const auto slice = AxisOfOneSlice(extent, options)) axes[*slice] = false;
  return WindowOf(extent, LastPointsOf(options.source), axes);
}

absl::Status MeasureAtBorder(const Volume& object, const SkeletonizeOptions& options,
                             const PointsByAxis& at_border, const Volume& thin,
                             exec::MemoryBudget& memory, const exec::Context& context,
                             std::vector<float>& radii) {
  std::unordered_map<LatticePoint, float, LatticePointHash> by_point;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (at_border[axis].empty()) continue;
    AxesAcross axes = {};
    axes[axis] = true;
    if (const auto slice = AxisOfOneSlice(object.extent(), options)) axes[*slice] = true;
    BCCSKEL_ASSIGN_OR_RETURN(
        const Volume space,
        ContinueBeyondBorder(object, LastPointsOf(options.source), axes, memory));
    VolumeBuilder builder(object.extent(), object.placement());
    for (LatticePoint p : at_border[axis]) builder.Add(p);
    BCCSKEL_ASSIGN_OR_RETURN(const Volume points, std::move(builder).Build());
    const ExactRadius search(space);
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<float> exact, ExactRadii(points, search, context));
    const auto voxel_units = static_cast<int32_t>(SurfaceStepOf(options.source));
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<float> stated,
                             MeasureVoxelRadii(space, voxel_units, search, points, exact, context));
    size_t n = 0;
    points.ForEachPoint([&](LatticePoint p) { by_point.emplace(p, stated[n++]); });
  }
  if (by_point.empty()) return absl::OkStatus();
  size_t n = 0;
  thin.ForEachPoint([&](LatticePoint p) {
    const auto found = by_point.find(p);
    if (found != by_point.end()) radii[n] = found->second;
    ++n;
  });
  return absl::OkStatus();
}

void DropShifts(const PointsByAxis& at_border, SkeletonGraph& graph) {
  std::unordered_set<LatticePoint, LatticePointHash> straight;
  for (const std::vector<LatticePoint>& points : at_border) {
    straight.insert(points.begin(), points.end());
  }
  if (straight.empty()) return;
  for (SkeletonPoint& p : graph.points) {
    if (straight.contains(p.point)) p.shift = {};
  }
}

}  // namespace bccskel
