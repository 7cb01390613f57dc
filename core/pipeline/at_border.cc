#include "core/pipeline/at_border.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/distance/exact_radius.h"
#include "core/exec/status_macros.h"
#include "core/lattice/lattice_point_hash.h"
#include "core/pipeline/canonical_options.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/prepare/beyond_border.h"
#include "core/pruning/cut_faces.h"
#include "core/skeleton/voxel_radii.h"

namespace bccskel {

namespace {

constexpr double kMostRadii = 2, kReachMargin = 8;  // lattice units

// The boxes of curves, each of which is given from neighbor to neighbor.
std::vector<LatticeBox> BoxesOfCurves(const std::vector<LatticePoint>& points) {
  constexpr int32_t kStep = 2;  // the longest between neighbors
  std::vector<LatticeBox> boxes;
  LatticePoint last;
  for (LatticePoint p : points) {
    const LatticePoint step = p - last;
    const bool goes_on = std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)}) <= kStep;
    if (boxes.empty() || !goes_on) boxes.push_back({p, p});
    LatticeBox& box = boxes.back();
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    last = p;
  }
  return boxes;
}

// The bricks of the object that are at most `reach`, in lattice units, from the curves' boxes, and
// some that are farther away.
Volume PartAround(const std::vector<LatticePoint>& curves, double reach, const Volume& object) {
  const AxisScale scale = AxisScaleOf(object.placement());
  const std::span<const BrickKey> all = object.keys();
  std::vector<char> is_near(all.size());
  for (const LatticeBox& box : BoxesOfCurves(curves)) {
    const auto before = [&](int32_t low, size_t axis, int32_t points) {
      return static_cast<int32_t>(std::max(std::floor(low - reach / scale[axis]), 0.0)) / points;
    };
    const auto behind = [&](int32_t high, size_t axis, int32_t points) {
      return static_cast<int32_t>(high + std::ceil(reach / scale[axis])) / points;
    };
    const BrickCoordinates low = {before(box.low.x, 0, 2 * kBrickX),
                                  before(box.low.y, 1, 2 * kBrickY),
                                  before(box.low.z, 2, 2 * kBrickZ)};
    const BrickCoordinates high = {behind(box.high.x, 0, 2 * kBrickX),
                                   behind(box.high.y, 1, 2 * kBrickY),
                                   behind(box.high.z, 2, 2 * kBrickZ), Sublattice::kOdd};
    for (int32_t bz = low.bz; bz <= high.bz; ++bz) {
      for (int32_t by = low.by; by <= high.by; ++by) {
        const BrickKey first({low.bx, by, bz, low.sublattice});
        const BrickKey last({high.bx, by, bz, high.sublattice});
        for (auto at = std::ranges::lower_bound(all, first); at != all.end() && *at <= last; ++at) {
          is_near[static_cast<size_t>(at - all.begin())] = 1;
        }
      }
    }
  }
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  for (BrickIndex n = 0; n < all.size(); ++n) {
    if (is_near[n] == 0) continue;
    keys.push_back(all[n]);
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
  ImageFaces faces = kAllFaces;
  if (const auto slice = AxisOfOneSlice(extent, options)) faces[*slice] = {false, false};
  return WindowOf(extent, LastPointsOf(options.source), faces);
}

absl::StatusOr<BeyondFaces> FindFaces(const Volume& object, const SkeletonizeOptions& options,
                                      Border border, exec::MemoryBudget& memory,
                                      const exec::Context& context) {
  const BorderPoints last = LastPointsOf(options.source);
  if (border == Border::kContinues && HasBackground(object, last)) {
    return BeyondFaces{kAllFaces, border};
  }
  if (const auto slice = AxisOfOneSlice(object.extent(), options)) {
    BeyondFaces across = {kNoFaces, Border::kContinuesAcrossSlice};
    across.faces[*slice] = {true, true};
    return across;
  }
  if (border != Border::kAuto) return BeyondFaces{kNoFaces, border};
  if (!IsConverted(options.source) || !HasCurves(options.thinning)) return BeyondFaces();
  BCCSKEL_ASSIGN_OR_RETURN(const ImageFaces faces,
                           FacesThatCutLimbs(object, WindowOf(object.extent(), last, kAllFaces),
                                             CellsPerVoxel(options.source), memory, context));
  return BeyondFaces{faces, faces == kNoFaces ? Border::kEnds : border};
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
    ImageFaces faces = kNoFaces;
    faces[axis] = {true, true};
    if (const auto slice = AxisOfOneSlice(object.extent(), options)) faces[*slice] = {true, true};
    BCCSKEL_ASSIGN_OR_RETURN(const Volume space,
                             ContinueBeyond(faces, part, LastPointsOf(options.source), memory));
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
