#include "core/prepare/beyond_border.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

// In lattice units, for a start: deeper than most vessels and neurites.
constexpr double kFirstDepth = 24;
// Of the bricks with points beyond: a distance field while it is made, and bits.
constexpr uint64_t kBytesPerBrick = 5120;

// A box of lattice points, ends included.
struct Box {
  LatticePoint low, high;

  bool Contains(LatticePoint p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
};

Box BoxWithin(const LatticeExtent& extent, BorderPoints border, LatticePoint shift) {
  const int32_t last = border == BorderPoints::kLastCorners ? 2 : 1;
  return {shift,
          shift + LatticePoint{2 * extent.nx - last, 2 * extent.ny - last, 2 * extent.nz - last}};
}

uint64_t PointCountOf(const LatticeExtent& extent, BorderPoints border) {
  if (border == BorderPoints::kLastOfLattice) return extent.PointCount();
  const LatticeExtent corners = extent, voxels = {extent.nx - 1, extent.ny - 1, extent.nz - 1};
  return (corners.PointCount() + voxels.PointCount()) / 2;
}

BrickBits PointsBeyond(const Box& box, BrickCoordinates brick) {
  BrickBits bits;
  const LatticePoint first = PointOf(brick, 0), last = PointOf(brick, kBrickPoints - 1);
  if (box.Contains(first) && box.Contains(last)) return bits;
  for (int bit = 0; bit < kBrickPoints; ++bit) {
    if (!box.Contains(PointOf(brick, bit))) bits.Set(bit);
  }
  return bits;
}

// The bricks from which the points beyond the box are at most `room` away.
Volume BricksNearSides(const Volume& object, const Box& box, BrickCoordinates room) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  const LatticePoint reach = ShiftOf(room) + LatticePoint{1, 1, 1};  // of the other sublattice
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates at = object.keys()[n].coordinates();
    if (box.Contains(PointOf(at, 0) - reach) && box.Contains(PointOf(at, kBrickPoints - 1) + reach))
      continue;
    keys.push_back(object.keys()[n]);
    bricks.push_back(object.bricks()[n]);
  }
  return Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                  std::move(bricks));
}

// The points beyond the box in bricks up to `room` away from the object.
absl::StatusOr<Volume> Beyond(const Volume& object, const Box& box, BrickCoordinates room,
                              exec::MemoryBudget& memory) {
  const Volume near = BricksNearSides(object, box, room);
  exec::MemoryShare share(memory);
  BCCSKEL_RETURN_IF_ERROR(share.TakeFor(MostBricksAround(near, room), kBytesPerListedBrick,
                                        "bricks to look beyond the border in"));
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  for (BrickKey key : BricksAround(near, room)) {
    const BrickBits bits = PointsBeyond(box, key.coordinates());
    if (bits.Empty()) continue;
    keys.push_back(key);
    bricks.push_back(bits);
  }
  return Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                  std::move(bricks));
}

absl::Status CheckRoom(const LatticeExtent& extent) {
  if (std::max({extent.nx, extent.ny, extent.nz}) <= kMaxExtentCells) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "extent of %d x %d x %d cells with room for what continues beyond the border: each axis must "
      "have at most %d",
      extent.nx, extent.ny, extent.nz, kMaxExtentCells));
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

DistanceField FieldOfPart(const Volume& part, const Volume& whole, const DistanceField& field) {
  return std::visit([&](const auto& values) { return CopyPart(part, whole, field, values); },
                    field.values());
}

absl::StatusOr<ContinuedObject> ContinueBeyondBorder(const Volume& object, BorderPoints border,
                                                     exec::MemoryBudget& memory,
                                                     const exec::Context& context) {
  const LatticeExtent& given = object.extent();
  // What has no background is equally deep wherever one stops looking for it.
  const bool full = object.PointCount() == PointCountOf(given, border);
  const double most = full ? kFirstDepth : 2.0 * std::max({given.nx, given.ny, given.nz});
  for (double depth = kFirstDepth;; depth *= 2) {
    const BrickCoordinates room = RoomFor(depth);
    const LatticeExtent extent = WithRoom(given, room);
    BCCSKEL_RETURN_IF_ERROR(CheckRoom(extent));
    Volume shifted = ShiftedBy(object, room, 1, extent);
    BCCSKEL_ASSIGN_OR_RETURN(
        const Volume beyond,
        Beyond(shifted, BoxWithin(given, border, ShiftOf(room)), room, memory));
    exec::MemoryShare share(memory);
    BCCSKEL_RETURN_IF_ERROR(
        share.TakeFor(beyond.brick_count(), kBytesPerBrick, "bricks beyond the border"));
    Volume space = Union(shifted, beyond);
    BCCSKEL_ASSIGN_OR_RETURN(const DistanceField field,
                             ComputeDistance(space, DistanceKind::kEuclidean, context));
    DistanceField distance = FieldOfPart(shifted, space, field);
    if (distance.ToLatticeUnits(distance.largest()) > depth && depth < most) continue;
    share.Keep();
    return ContinuedObject{room, std::move(shifted), std::move(space), std::move(distance)};
  }
}

}  // namespace bccskel
