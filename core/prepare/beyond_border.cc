#include "core/prepare/beyond_border.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/lattice/directions.h"
#include "core/prepare/brick_sets.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

// Memory per brick with points beyond the border: bits and neighbors, and distances while they are
// measured.
constexpr uint64_t kBytesPerBrick = 5120;
// Memory per other brick: bits and neighbors. The object has distances for them anyway.
constexpr uint64_t kBytesPerCopiedBrick = 256;

// The object's bricks and adjacent ones that have points beyond the window.
std::vector<BrickKey> BricksBeyond(const Volume& object, const LatticeBox& window) {
  std::vector<BrickKey> keys;
  const auto add = [&](BrickCoordinates brick) {
    const bool exists = std::min({brick.bx, brick.by, brick.bz}) >= 0;
    if (exists && !window.Contains(BoxOf(brick))) keys.push_back(BrickKey(brick));
  };
  constexpr LatticePoint kBrick = {2 * kBrickX, 2 * kBrickY, 2 * kBrickZ};
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates brick = object.keys()[n].coordinates();
    const auto [low, high] = BoxOf(brick);
    if (window.Contains(LatticeBox{low - kBrick, high + kBrick})) continue;
    add(brick);
    for (int position = 0; position < kNeighborCount; ++position) {
      const bool is_stored =
          object.neighbors()[n][static_cast<size_t>(position)] != object.brick_count();
      if (!is_stored) add(NeighborBrick(brick, position));
    }
  }
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

// The points beyond the window in these bricks.
Volume PointsBeyond(const Volume& object, const LatticeBox& window, std::vector<BrickKey> keys) {
  std::vector<BrickBits> bricks(keys.size());
  for (size_t n = 0; n < keys.size(); ++n) {
    bricks[n] = ~PointsIn(keys[n].coordinates(), window);
  }
  const LatticeExtent& inside = object.extent();
  return Volume::FromSortedBricks({inside.nx + kBrickX, inside.ny + kBrickY, inside.nz + kBrickZ},
                                  object.placement(), std::move(keys), std::move(bricks));
}

// Moves the values of the part's points to the front, in place: its bricks are among those of the
// whole. Returns the largest.
template <typename Value>
uint32_t KeepPart(const Volume& part, const Volume& whole,
                  exec::UninitializedVector<Value>& values) {
  uint32_t largest = 0;  // integers, so that the loop vectorizes
  for (BrickIndex n = 0; n < part.brick_count(); ++n) {
    const BrickIndex source = *whole.Find(part.keys()[n]);
    const Value* from = &values[size_t{source} * kBrickPoints];
    Value* to = &values[size_t{n} * kBrickPoints];
    if (source != n) std::copy_n(from, kBrickPoints, to);
    const BrickBits others = whole.bricks()[source] & ~part.bricks()[n];
    others.ForEachSetBit([&](int bit) { to[bit] = 0; });
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      largest = std::max(largest, DistanceField::RankOf(to[bit]));
    }
  }
  values.resize((part.brick_count() + 1) * kBrickPoints);
  std::fill_n(values.end() - kBrickPoints, kBrickPoints, Value{0});
  return largest;
}

}  // namespace

bool HasBackground(const Volume& object, BorderPoints border) {
  const LatticeExtent& extent = object.extent();
  if (border == BorderPoints::kLastOfLattice) return object.PointCount() < extent.PointCount();
  const LatticeExtent voxels = {extent.nx - 1, extent.ny - 1, extent.nz - 1};
  return object.PointCount() < (extent.PointCount() + voxels.PointCount()) / 2;
}

LatticeBox WindowOf(const LatticeExtent& extent, BorderPoints border, const ImageFaces& faces) {
  constexpr int32_t kBeyondAll = 4 * kMaxExtentCells;
  const int32_t last = border == BorderPoints::kLastCorners ? 2 : 1;
  const auto low = [&](size_t axis) { return faces[axis][0] ? 0 : -kBeyondAll; };
  const auto high = [&](size_t axis, int32_t cells) {
    return faces[axis][1] ? 2 * cells - last : kBeyondAll;
  };
  return {{low(0), low(1), low(2)}, {high(0, extent.nx), high(1, extent.ny), high(2, extent.nz)}};
}

absl::StatusOr<DistanceField> MeasureIn(const Volume& space, const Volume& object,
                                        DistanceKind kind, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(DistanceField field, ComputeDistance(space, kind, context));
  const ChamferWeights weights = field.weights();
  DistanceField::Values values = std::move(field).TakeValues();
  const uint32_t largest =
      std::visit([&](auto& found) { return KeepPart(object, space, found); }, values);
  return DistanceField(kind, weights, std::move(values), largest);
}

absl::StatusOr<Volume> ContinueBeyond(const ImageFaces& faces, const Volume& object,
                                      BorderPoints border, exec::MemoryBudget& memory) {
  if (faces == kAllFaces && !HasBackground(object, border)) return object;
  const LatticeBox window = WindowOf(object.extent(), border, faces);
  std::vector<BrickKey> keys = BricksBeyond(object, window);
  const auto added = static_cast<uint64_t>(
      std::ranges::count_if(keys, [&](BrickKey key) { return !object.Find(key).has_value(); }));
  BCCSKEL_RETURN_IF_ERROR(memory.TakeFor(object.brick_count(), kBytesPerCopiedBrick,
                                         "bricks with what is beyond the border"));
  BCCSKEL_RETURN_IF_ERROR(memory.TakeFor(added, kBytesPerBrick, "bricks beyond the border"));
  Volume space = Union(PointsBeyond(object, window, std::move(keys)), object);
  space.SetWindow(window);
  return space;
}

}  // namespace bccskel
