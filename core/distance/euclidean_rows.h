#ifndef BCCSKEL_CORE_DISTANCE_EUCLIDEAN_ROWS_H_
#define BCCSKEL_CORE_DISTANCE_EUCLIDEAN_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/distance/side_runs.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

// The inner loops of the Euclidean distance, for one or two rows of 16 points at a time; compiled
// for every instruction set and picked at run time. See euclidean_scan.cc for what they add up to.
//
// Squares are of type T: uint16_t, whole squared lattice units with saturation, where the spacing
// is the same along all axes and the object is not too deep, else float.

namespace bccskel {

// A layer's 64 points and a brick's layers, with one more layer beside them.
inline constexpr size_t kLayerPoints = kBrickX * kBrickY;
inline constexpr size_t kLayersBeside = kBrickZ + 1;

// In 16 bits, lengths along a row are cut off at the root of this, and so squares from here on may
// be too small. Those below are right: they are sums of lengths that were not cut off.
inline constexpr uint16_t kFirstUnsureSquare = 255 * 255;

// What the loops work on. Squared distances in lattice units.
template <typename T>
struct EuclideanView {
  const BrickBits* object = nullptr;
  const BrickNeighborhood* neighbors = nullptr;
  BrickIndex padding = 0;  // the brick that stands for those not stored
  // Shapes: kBrickPoints per brick. First within the layer, to background of the same sublattice;
  //         in the end to all background.
  T* own = nullptr;
  // Shapes: kLayersBeside * kLayerPoints per brick. From the places above (even brick) or below
  //         (odd brick) its points, within the layer of the other sublattice that lies there, to
  //         that layer's background. The last layer is the one on the other side of the brick.
  T* beside = nullptr;
};

// Squared lengths along the axes.
template <typename T>
struct SquaredLengths {
  T x = 1;           // of one unit along x
  std::vector<T> y;  // of n units along y, as many as the longest stack needs
  std::vector<T> z;  // of n units along z
};

// A stack of stored bricks of one sublattice, each the next one's neighbor along an axis.
using BrickStack = std::span<const BrickIndex>;

// What follows before and after a stack: background, or points outside the window, from which there
// is no distance to take. Only for floats.
struct StackEnds {
  bool unknown_before = false;
  bool unknown_after = false;

  constexpr bool AreKnown() const { return !unknown_before && !unknown_after; }
};
// The run beside a row with no background before the end of the window: longer than any other.
inline constexpr uint32_t kUnknownRun = uint32_t{1} << 26;
// Rows that loops may look past the ends of a stack.
inline constexpr size_t kMostEndRows = 20;

// Some of the kBrickZ layers of points that each brick of a stack along y has.
struct LayersOfBrick {
  size_t first = 0;
  size_t end = kBrickZ;
};

// Distances within the layers of a stack along y: `own` of its bricks, `beside` of the bricks of
// the other sublattice that lie at the same place.
// Shapes: `runs` of all bricks.
void ScanLayers(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                const SideRuns<uint32_t>& runs);
void ScanLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                const SideRuns<uint32_t>& runs);

// From distances within layers to distances in space: `own` of a stack along z.
// Needs: ScanLayers() for all stacks.
void ScanAcrossLayers(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                      Sublattice sublattice, BrickStack stack, StackEnds ends);
void ScanAcrossLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                      Sublattice sublattice, BrickStack stack, StackEnds ends);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_ROWS_H_
