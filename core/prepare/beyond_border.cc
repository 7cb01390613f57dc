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

uint64_t PointCountOf(const LatticeExtent& extent, BorderPoints border) {
  if (border == BorderPoints::kLastOfLattice) return extent.PointCount();
  const LatticeExtent corners = extent, voxels = {extent.nx - 1, extent.ny - 1, extent.nz - 1};
  return (corners.PointCount() + voxels.PointCount()) / 2;
}

// The object's bricks and adjacent ones that have points beyond the window.
std::vector<BrickKey> BricksBeyond(const Volume& object, const LatticeBox& window) {
  std::vector<BrickKey> keys;
  const auto add = [&](BrickCoordinates brick) {
    const bool exists = std::min({brick.bx, brick.by, brick.bz}) >= 0;
    if (exists && !window.Contains(BoxOf(brick))) keys.push_back(BrickKey(brick));
  };
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates brick = object.keys()[n].coordinates();
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
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      if (!window.Contains(PointOf(keys[n].coordinates(), bit))) bricks[n].Set(bit);
    }
  }
  const LatticeExtent& inside = object.extent();
  return Volume::FromSortedBricks({inside.nx + kBrickX, inside.ny + kBrickY, inside.nz + kBrickZ},
                                  object.placement(), std::move(keys), std::move(bricks));
}

template <typename Value>
DistanceField CopyPart(const Volume& part, const Volume& whole, const DistanceField& field,
                       const exec::UninitializedVector<Value>& from) {
  exec::UninitializedVector<Value> to((part.brick_count() + 1) * kBrickPoints);
  std::ranges::fill(to, Value{0});
  uint32_t largest = 0;
  for (BrickIndex n = 0; n < part.brick_count(); ++n) {
    const size_t source = size_t{*whole.Find(part.keys()[n])} * kBrickPoints;
    part.bricks()[n].ForEachSetBit([&](int bit) {
      const Value value = from[source + static_cast<size_t>(bit)];
      to[size_t{n} * kBrickPoints + static_cast<size_t>(bit)] = value;
      largest = std::max(largest, DistanceField::RankOf(value));
    });
  }
  return DistanceField(field.kind(), field.weights(), std::move(to), largest);
}

}  // namespace

LatticeBox WindowOf(const LatticeExtent& extent, BorderPoints border, const AxesAcross& axes) {
  constexpr int32_t kBeyondAll = 4 * kMaxExtentCells;
  const int32_t last = border == BorderPoints::kLastCorners ? 2 : 1;
  const auto low = [&](size_t axis) { return axes[axis] ? 0 : -kBeyondAll; };
  const auto high = [&](size_t axis, int32_t cells) {
    return axes[axis] ? 2 * cells - last : kBeyondAll;
  };
  return {{low(0), low(1), low(2)}, {high(0, extent.nx), high(1, extent.ny), high(2, extent.nz)}};
}

absl::StatusOr<DistanceField> MeasureIn(const Volume& space, const Volume& object,
                                        DistanceKind kind, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const DistanceField field, ComputeDistance(space, kind, context));
  return std::visit([&](const auto& values) { return CopyPart(object, space, field, values); },
                    field.values());
}

absl::StatusOr<Volume> ContinueBeyondBorder(const Volume& object, BorderPoints border,
                                            const AxesAcross& axes, exec::MemoryBudget& memory) {
  const LatticeExtent& extent = object.extent();
  if (axes == kAllAxes && object.PointCount() == PointCountOf(extent, border)) return object;
  const LatticeBox window = WindowOf(extent, border, axes);
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
