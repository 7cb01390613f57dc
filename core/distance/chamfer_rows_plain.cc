#include <algorithm>
#include <array>
#include <limits>

#include "core/distance/chamfer_rows.h"

namespace bccskel {
namespace {

using View = DistanceView<uint32_t>;

uint32_t* Row(const View& view, BrickIndex brick, int k, int j) {
  return view.values + size_t{brick} * kBrickPoints + static_cast<size_t>(64 * k + kBrickX * j);
}

// Within a wide flat layer the first pass can overflow the type; the far value then means "more
// than any final distance".
uint32_t SaturatedSum(uint32_t a, uint32_t b) {
  const uint32_t sum = a + b;
  return sum < a ? std::numeric_limits<uint32_t>::max() : sum;
}

void SweepRowForward(const View& view, BrickIndex brick, int k, int j) {
  const uint64_t bits = view.object[brick].words[static_cast<size_t>(k)] >> (kBrickX * j);
  const BrickNeighborhood& near = view.neighbors[brick];
  const uint32_t* below = j > 0 ? Row(view, brick, k, j - 1) : Row(view, near[11], k, kBrickY - 1);
  uint32_t* row = Row(view, brick, k, j);
  uint32_t previous = Row(view, near[9], k, j)[kBrickX - 1];
  for (int i = 0; i < kBrickX; ++i) {
    const uint32_t nearer = std::min(SaturatedSum(previous, view.weights.axial[0]),
                                     SaturatedSum(below[i], view.weights.axial[1]));
    previous = (bits >> i & 1) != 0 ? nearer : 0;
    row[i] = previous;
  }
}

void SweepRowBackward(const View& view, BrickIndex brick, int k, int j) {
  const BrickNeighborhood& near = view.neighbors[brick];
  const uint32_t* above = j + 1 < kBrickY ? Row(view, brick, k, j + 1) : Row(view, near[10], k, 0);
  uint32_t* row = Row(view, brick, k, j);
  uint32_t previous = Row(view, near[8], k, j)[0];
  for (int i = kBrickX - 1; i >= 0; --i) {
    previous = std::min({row[i], SaturatedSum(previous, view.weights.axial[0]),
                         SaturatedSum(above[i], view.weights.axial[1])});
    row[i] = previous;
  }
}

void JoinRow(const View& view, BrickIndex brick, Sublattice sublattice, int k, int j,
             const AdjacentLayers& layers) {
  const bool even = sublattice == Sublattice::kEven;
  const int side = even ? j - 1 : j + 1;
  const bool outside = side < 0 || side == kBrickY;
  const int side_j = side & (kBrickY - 1);
  const uint32_t* own = Row(view, layers.diagonal[0], layers.diagonal_k, j);
  const uint32_t* own_x = Row(view, layers.diagonal[1], layers.diagonal_k, j);
  const uint32_t* next = Row(view, layers.diagonal[outside ? 2 : 0], layers.diagonal_k, side_j);
  const uint32_t* next_x = Row(view, layers.diagonal[outside ? 3 : 1], layers.diagonal_k, side_j);
  // The smaller of the two rows, with the column that the brick beside contributes.
  std::array<uint32_t, kBrickX + 1> nearest;
  for (size_t i = 0; i < kBrickX; ++i) nearest[even ? i + 1 : i] = std::min(own[i], next[i]);
  nearest[even ? 0 : kBrickX] =
      even ? std::min(own_x[kBrickX - 1], next_x[kBrickX - 1]) : std::min(own_x[0], next_x[0]);
  const uint32_t* straight = Row(view, layers.axial, layers.axial_k, j);
  uint32_t* row = Row(view, brick, k, j);
  for (size_t i = 0; i < kBrickX; ++i) {
    const uint32_t by_diagonal =
        SaturatedSum(std::min(nearest[i], nearest[i + 1]), view.weights.diagonal);
    row[i] = std::min({row[i], by_diagonal, SaturatedSum(straight[i], view.weights.axial[2])});
  }
}

}  // namespace

void SweepWithinLayers(const View& view, BrickIndex first, BrickIndex last) {
  for (BrickIndex brick = first; brick < last; ++brick) {
    for (int k = 0; k < kBrickZ; ++k) {
      for (int j = 0; j < kBrickY; ++j) SweepRowForward(view, brick, k, j);
    }
  }
  for (BrickIndex brick = last; brick-- > first;) {
    for (int k = 0; k < kBrickZ; ++k) {
      for (int j = kBrickY - 1; j >= 0; --j) SweepRowBackward(view, brick, k, j);
    }
  }
}

void JoinLayers(const View& view, Sublattice sublattice, std::span<const BrickIndex> bricks, int k,
                ScanDirection direction) {
  for (BrickIndex brick : bricks) {
    const BrickNeighborhood& near = view.neighbors[brick];
    const AdjacentLayers layers = direction == ScanDirection::kUpward
                                      ? LayersBelow(near, brick, sublattice, k)
                                      : LayersAbove(near, brick, sublattice, k);
    for (int j = 0; j < kBrickY; ++j) JoinRow(view, brick, sublattice, k, j, layers);
  }
}

uint32_t LargestOf(std::span<const uint32_t> values) {
  return values.empty() ? 0 : *std::ranges::max_element(values);
}

}  // namespace bccskel
