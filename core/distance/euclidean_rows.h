#ifndef BCCSKEL_CORE_DISTANCE_EUCLIDEAN_ROWS_H_
#define BCCSKEL_CORE_DISTANCE_EUCLIDEAN_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/distance/side_runs.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

// The inner loops of the Euclidean distance, for one or two rows of 16 points at a time, compiled
// for every instruction set and selected at run time. euclidean_scan.cc explains how they combine.
//
// Squares are of type T: uint16_t, whole squared lattice units with saturation, where the spacing
// is the same along all axes and the object is not too deep; otherwise float.

namespace bccskel {

// The points of a layer of a brick, and the layers of `beside`: a brick's own and one more.
inline constexpr size_t kLayerPoints = kBrickX * kBrickY;
inline constexpr size_t kLayersBeside = kBrickZ + 1;

// In 16 bits, lengths along a row are clipped at 255, so squares from 255 * 255 on may be too
// small. Smaller squares are right: they are sums of unclipped lengths.
inline constexpr uint16_t kFirstUnsureSquare = 255 * 255;

// The data of the loops: squared distances in lattice units.
template <typename T>
struct EuclideanView {
  const BrickBits* object = nullptr;
  const BrickNeighborhood* neighbors = nullptr;
  BrickIndex padding = 0;  // the brick that stands for those not stored
  // Shapes: kBrickPoints per brick. First the distances within the layer, to background of the same
  //         sublattice; in the end those to all background.
  T* own = nullptr;
  // Shapes: kLayersBeside * kLayerPoints per brick. Distances from the positions above (even brick)
  //         or below (odd brick) its points to the background of the layer of the other sublattice
  //         that contains these positions. The last layer is the one on the other side of the
  //         brick.
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

// What lies before and after a stack: background, or points outside the window, which give no
// distance.
struct StackEnds {
  bool unknown_before = false;
  bool unknown_after = false;

  constexpr bool AreKnown() const { return !unknown_before && !unknown_after; }
};
// The run beside a row that has no background up to the end of the window: longer than any real
// run.
inline constexpr uint32_t kUnknownRun = uint32_t{1} << 26;
// The most rows that loops may read beyond the ends of a stack: in 16 bits, steps of more than 255
// units find nothing nearer; floats take 16 at most.
template <typename T>
inline constexpr size_t kMostEndRows = 260;
template <>
inline constexpr size_t kMostEndRows<float> = 20;

// The layers [first, end) of each brick of a stack along y.
struct LayersOfBrick {
  size_t first = 0;
  size_t end = kBrickZ;
};

// Computes distances within the layers of a stack along y: `own` of its bricks, and `beside` of the
// bricks of the other sublattice at the same coordinates.
// Shapes: `runs` of all bricks.
void ScanLayers(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                const SideRuns<uint32_t>& runs);
void ScanLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                const SideRuns<uint32_t>& runs);

// Turns distances within layers into distances in space: `own` of a stack along z.
// Needs: ScanLayers() for all stacks.
void ScanAcrossLayers(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                      Sublattice sublattice, BrickStack stack, StackEnds ends);
void ScanAcrossLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                      Sublattice sublattice, BrickStack stack, StackEnds ends);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_ROWS_H_
