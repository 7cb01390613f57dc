#ifndef BCCSKEL_CORE_DISTANCE_CHAMFER_ROWS_H_
#define BCCSKEL_CORE_DISTANCE_CHAMFER_ROWS_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/distance/chamfer_weights.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

// The inner loops of the chamfer distance, for rows of 16 points. The 16-bit versions are compiled
// for every instruction set and picked at run time; the 32-bit ones, for objects deeper than 620
// lattice units and for steps longer than FitShortRows() allows, are plain loops.

namespace bccskel {

// Distances along x within eight points of a row, in 16-bit counts.
struct RunTables {
  static constexpr int kPoints = 8;
  // Means "more than any final distance".
  static constexpr uint32_t kFar = 0xffff;

  // Indexed by the bits of the points: distances to the nearest background point among them.
  alignas(16) std::array<std::array<uint16_t, kPoints>, 256> inside = {};
  // Distances from the point before the first, and from the point after the last.
  alignas(16) std::array<uint16_t, kPoints> up = {};
  alignas(16) std::array<uint16_t, kPoints> down = {};
  uint32_t axial = 0;        // counts of a step along x
  uint32_t longest_run = 0;  // runs along x are followed for this many steps

  // Distances below this are exact; larger ones may have any value from here up.
  uint32_t limit() const { return longest_run * axial; }
};
RunTables RunTablesFor(const ChamferWeights& weights);

// Whether steps are short enough for 16-bit distances to pay.
bool FitShortRows(const ChamferWeights& weights);

// The data of the loops. Shapes: `values` holds kBrickPoints per brick of the object in bit order,
// then as many zeros for the padding brick. If a window has bricks beside it, as many of the
// largest number follow, for the brick that represents those.
template <typename T>
struct DistanceView {
  const BrickBits* object = nullptr;
  const BrickNeighborhood* neighbors = nullptr;
  T* values = nullptr;
  ChamferWeights weights;
  const RunTables* runs = nullptr;  // 16 bits only
  std::optional<BrickIndex> unknown = std::nullopt;
};

// Which adjacent layers a scan takes distances from.
enum class ScanDirection : uint8_t { kUpward, kDownward };

// Distances by D6 steps along x and y within the layers of the bricks [first, last).
// Needs: the bricks are whole layers of bricks (all of one bz), in the order of a Volume.
void SweepWithinLayers(const DistanceView<uint16_t>& view, BrickIndex first, BrickIndex last);
void SweepWithinLayers(const DistanceView<uint32_t>& view, BrickIndex first, BrickIndex last);

// Propagates distances from the adjacent layer of the other sublattice (four D8 steps) and the next
// layer of the same one (a D6 step along z) to layer k of the given bricks.
// Needs: `bricks` are of `sublattice`; no thread writes the adjacent layers during the call.
void JoinLayers(const DistanceView<uint16_t>& view, Sublattice sublattice,
                std::span<const BrickIndex> bricks, int k, ScanDirection direction);
void JoinLayers(const DistanceView<uint32_t>& view, Sublattice sublattice,
                std::span<const BrickIndex> bricks, int k, ScanDirection direction);

// Shapes: whole bricks.
uint16_t LargestOf(std::span<const uint16_t> values);
uint32_t LargestOf(std::span<const uint32_t> values);

// Where layer k of a brick finds its adjacent layers.
struct AdjacentLayers {
  // Bricks of the other sublattice: at the same place, beside it in x, in y, and in both.
  const BrickIndex* diagonal = nullptr;
  int diagonal_k = 0;
  BrickIndex axial = 0;
  int axial_k = 0;
};

// Below the even layer of index k lies the odd layer k - 1, below the odd layer k the even layer k;
// positions 4 to 7 of a neighborhood are the bricks one step along z.
inline AdjacentLayers LayersBelow(const BrickNeighborhood& near, BrickIndex own,
                                  Sublattice sublattice, int k) {
  const BrickIndex axial = k > 0 ? own : near[13];
  if (sublattice == Sublattice::kOdd) return {&near[0], k, axial, (k + 7) & 7};
  return {k > 0 ? &near[0] : &near[4], (k + 7) & 7, axial, (k + 7) & 7};
}
inline AdjacentLayers LayersAbove(const BrickNeighborhood& near, BrickIndex own,
                                  Sublattice sublattice, int k) {
  const BrickIndex axial = k < 7 ? own : near[12];
  if (sublattice == Sublattice::kEven) return {&near[0], k, axial, (k + 1) & 7};
  return {k < 7 ? &near[0] : &near[4], (k + 1) & 7, axial, (k + 1) & 7};
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_CHAMFER_ROWS_H_
