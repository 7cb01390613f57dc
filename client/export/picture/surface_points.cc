#include "client/export/picture/surface_points.h"

#include "core/volume/brick_neighbors.h"

namespace bccskel::exporting {
namespace {

// Positions of the D6 neighbors in a BrickNeighborhood.
enum D6Brick : size_t { kPlusX = 8, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ };

constexpr uint64_t kFirstInLane = 0x0001000100010001;
constexpr uint64_t kLastInLane = 0x8000800080008000;

// Points of layer k whose six D6 neighbors are all object points. See core/volume/brick.h for what
// a word's bits mean.
uint64_t InnerPoints(std::span<const BrickBits> padded, const BrickNeighborhood& around,
                     const BrickBits& brick, size_t k) {
  const auto word = [&](D6Brick side, size_t layer) { return padded[around[side]].words[layer]; };
  const uint64_t here = brick.words[k];
  const uint64_t after_x = (here >> 1 & ~kLastInLane) | (word(kPlusX, k) << 15 & kLastInLane);
  const uint64_t before_x = (here << 1 & ~kFirstInLane) | (word(kMinusX, k) >> 15 & kFirstInLane);
  const uint64_t after_y = here >> 16 | word(kPlusY, k) << 48;
  const uint64_t before_y = here << 16 | word(kMinusY, k) >> 48;
  const uint64_t after_z = k + 1 < kBrickZ ? brick.words[k + 1] : word(kPlusZ, 0);
  const uint64_t before_z = k > 0 ? brick.words[k - 1] : word(kMinusZ, kBrickZ - 1);
  return here & after_x & before_x & after_y & before_y & after_z & before_z;
}

}  // namespace

std::vector<LatticePoint> SurfacePoints(const Volume& object) {
  const std::vector<BrickNeighborhood> neighbors = FindBrickNeighbors(object.keys());
  std::vector<LatticePoint> points;
  for (size_t n = 0; n < object.brick_count(); ++n) {
    const BrickBits& brick = object.bricks()[n];
    BrickBits surface;
    for (size_t k = 0; k < kBrickZ; ++k) {
      const uint64_t inner = InnerPoints(object.padded_bricks(), neighbors[n], brick, k);
      surface.words[k] = brick.words[k] & ~inner;
    }
    const BrickCoordinates at = object.keys()[n].coordinates();
    surface.ForEachSetBit([&](int bit) { points.push_back(PointOf(at, bit)); });
  }
  return points;
}

}  // namespace bccskel::exporting
