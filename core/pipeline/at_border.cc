#include "core/pipeline/at_border.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/distance/exact_radius.h"
#include "core/exec/status_macros.h"
#include "core/lattice/lattice_point_hash.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/prepare/beyond_border.h"
#include "core/skeleton/voxel_radii.h"

namespace bccskel {

namespace {

constexpr double kMostRadii = 2, kReachMargin = 8;  // lattice units

// The bricks of the object that are at most `reach`, in lattice units, from those of the points.
Volume PartAround(const std::vector<LatticePoint>& points, double reach, const Volume& object) {
  const AxisScale scale = AxisScaleOf(object.placement());
  std::vector<BrickKey> homes;
  for (LatticePoint p : points) homes.emplace_back(AddressOf(p).brick);
  std::ranges::sort(homes);
  homes.erase(std::unique(homes.begin(), homes.end()), homes.end());
  const auto is_near = [&](const LatticeBox& a, BrickKey home) {
    const LatticeBox b = BoxOf(home.coordinates());
    const auto apart = [&](int32_t low_a, int32_t high_a, int32_t low_b, int32_t high_b) {
      return std::max({0, low_a - high_b, low_b - high_a});
    };
    return scale[0] * apart(a.low.x, a.high.x, b.low.x, b.high.x) <= reach &&
           scale[1] * apart(a.low.y, a.high.y, b.low.y, b.high.y) <= reach &&
           scale[2] * apart(a.low.z, a.high.z, b.low.z, b.high.z) <= reach;
  };
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    const LatticeBox box = BoxOf(object.keys()[n].coordinates());
    if (std::ranges::none_of(homes, [&](BrickKey home) { return is_near(box, home); })) continue;
    keys.push_back(object.keys()[n]);
    bricks.push_back(object.bricks()[n]);
  }
  return Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                  std::move(bricks));
}

}  // namespace

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
  if (radii.empty()) return absl::OkStatus();
  std::unordered_map<LatticePoint, float, LatticePointHash> by_point;
  // No limb is much thicker than the thickest; beyond that part there might as well be background.
  const double reach = kMostRadii * std::ranges::max(radii) + kReachMargin;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (at_border[axis].empty()) continue;
    const Volume part = PartAround(at_border[axis], reach, object);
    AxesAcross axes = {};
    axes[axis] = true;
    if (const auto slice = AxisOfOneSlice(object.extent(), options)) axes[*slice] = true;
    BCCSKEL_ASSIGN_OR_RETURN(
        const Volume space, ContinueBeyondBorder(part, LastPointsOf(options.source), axes, memory));
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
