#include "core/distance/border_bricks.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/lattice/directions.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

constexpr LatticePoint kOneCell = {2, 2, 2};

LatticePoint Lower(LatticePoint a, LatticePoint b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
LatticePoint Upper(LatticePoint a, LatticePoint b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

std::array<float, 3> AxesOf(LatticePoint p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

void Append(const std::array<float, 3>& low, const std::array<float, 3>& high, Boxes& boxes) {
  for (size_t axis = 0; axis < 3; ++axis) {
    boxes.low[axis].push_back(low[axis]);
    boxes.high[axis].push_back(high[axis]);
  }
}

void Pad(Boxes& boxes) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  while (boxes.size() % kBoxGroup != 0) {
    Append({kFar, kFar, kFar}, {kFar, kFar, kFar}, boxes);
  }
}

}  // namespace

BorderBricks::BorderBricks(const Volume& object) {
  const std::span<const BrickNeighborhood> neighbors = object.neighbors();
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    first_of_.push_back(static_cast<uint32_t>(places_.size()));
    AddBackgroundOf(object, n);
    AddBackgroundBeside(object, neighbors[n], n);
  }
  first_of_.push_back(static_cast<uint32_t>(places_.size()));
  Pad(boxes_);
  size_t count = places_.size();
  do {
    groups_.push_back(Grouped(groups_.empty() ? boxes_ : groups_.back(), count));
    count = (count + kBoxGroup - 1) / kBoxGroup;
  } while (count > kBoxGroup);
}

// Needs: some bits are set.
BorderBricks::CellBox BorderBricks::BoxAround(const BrickBits& bits, BrickCoordinates brick) {
  uint64_t any = 0;
  int first = kBrickZ, last = 0;
  for (int k = 0; k < kBrickZ; ++k) {
    const uint64_t word = bits.words[static_cast<size_t>(k)];
    any |= word;
    if (word == 0) continue;
    first = std::min(first, k);
    last = k;
  }
  const uint64_t two_rows = any | any >> 32;
  const auto row = static_cast<uint16_t>(two_rows | two_rows >> 16);
  const int low = 64 * first + (std::countr_zero(any) & ~15) + std::countr_zero(row);
  const int high = 64 * last + ((63 - std::countl_zero(any)) & ~15) + 15 - std::countl_zero(row);
  return {PointOf(brick, low), PointOf(brick, high)};
}

void BorderBricks::AddBackgroundOf(const Volume& object, BrickIndex n) {
  const BrickBits& bits = object.bricks()[n];
  if (IsFull(bits)) return;
  const BrickCoordinates brick = object.keys()[n].coordinates();
  Add({n, PointOf(brick, 0)}, BoxAround(~bits, brick));
}

// Adds background of bricks that are not stored, as far as it may lie next to points of brick n.
void BorderBricks::AddBackgroundBeside(const Volume& object, const BrickNeighborhood& near,
                                       BrickIndex n) {
  const auto none = static_cast<BrickIndex>(object.brick_count());
  if (std::ranges::find(near, none) == near.end()) return;
  const BrickCoordinates brick = object.keys()[n].coordinates();
  const CellBox points = BoxAround(object.bricks()[n], brick);
  for (int position = 0; position < kNeighborCount; ++position) {
    if (near[static_cast<size_t>(position)] != none) continue;
    const BrickCoordinates other = NeighborBrick(brick, position);
    if (object.IsUnknown(other)) continue;
    const LatticePoint first = PointOf(other, 0), last = PointOf(other, kBrickPoints - 1);
    const CellBox box = {Upper(points.low - kOneCell, first), Lower(points.high + kOneCell, last)};
    if (box.low.x > box.high.x || box.low.y > box.high.y || box.low.z > box.high.z) continue;
    Add({none, first}, box);
  }
}

void BorderBricks::Add(const Place& place, const CellBox& box) {
  places_.push_back(place);
  Append(AxesOf(box.low), AxesOf(box.high), boxes_);
}

// The groups of `count` boxes, which are not padded.
Boxes BorderBricks::Grouped(const Boxes& boxes, size_t count) {
  Boxes groups;
  for (size_t n = 0; n < count; n += kBoxGroup) {
    const size_t in_group = std::min(kBoxGroup, count - n);
    std::array<float, 3> low, high;
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::ranges::min(std::span(boxes.low[axis]).subspan(n, in_group));
      high[axis] = std::ranges::max(std::span(boxes.high[axis]).subspan(n, in_group));
    }
    Append(low, high, groups);
  }
  Pad(groups);
  return groups;
}

}  // namespace bccskel
