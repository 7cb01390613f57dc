#include "core/import/shapes/boundary_noise.h"

#include <vector>

#include "core/lattice/directions.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel::shapes {
namespace {

// The finalizer of SplitMix64: every input bit changes every output bit with probability 1/2.
constexpr uint64_t Mixed(uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9;
  v = (v ^ (v >> 27)) * 0x94d049bb133111eb;
  return v ^ (v >> 31);
}

class Flips {
 public:
  Flips(double fraction, uint64_t seed)
      : threshold_(static_cast<uint64_t>(fraction * 0x1p53)), seed_(Mixed(seed)) {}

  bool At(LatticePoint p) const {
    const auto field = [](int32_t c) { return static_cast<uint64_t>(static_cast<uint32_t>(c)); };
    const uint64_t hash = Mixed(Mixed(seed_ ^ field(p.z) << 32 ^ field(p.y)) ^ field(p.x));
    return hash >> 11 < threshold_;
  }

 private:
  uint64_t threshold_;
  uint64_t seed_;
};

// Visits the neighbors of one brick's points without searching for their bricks.
class BrickSurroundings {
 public:
  BrickSurroundings(const Volume& object, BrickIndex index, const BrickNeighborhood& neighbors)
      : object_(object),
        index_(index),
        neighbors_(neighbors),
        brick_(object.keys()[index].coordinates()) {}

  LatticePoint PointAt(int bit) const { return PointOf(brick_, bit); }

  bool Contains(LatticePoint p, Direction d) const {
    const BrickAddress address = AddressOf(p + d.offset());
    return object_.padded_bricks()[IndexOf(address.brick, d)].Test(address.bit);
  }

 private:
  BrickIndex IndexOf(BrickCoordinates other, Direction d) const {
    if (other == brick_) return index_;
    if (!d.is_diagonal()) return neighbors_[static_cast<size_t>(d.bit())];
    const unsigned position = (other.bx != brick_.bx ? 1u : 0u) |
                              (other.by != brick_.by ? 2u : 0u) | (other.bz != brick_.bz ? 4u : 0u);
    return neighbors_[position];
  }

  const Volume& object_;
  const BrickIndex index_;
  const BrickNeighborhood& neighbors_;
  const BrickCoordinates brick_;
};

void FlipAround(const BrickSurroundings& surroundings, int bit, const Flips& flips,
                VolumeBuilder& builder) {
  const LatticePoint p = surroundings.PointAt(bit);
  bool on_boundary = false;
  for (int n = 0; n < kNeighborCount; ++n) {
    const Direction d(n);
    if (surroundings.Contains(p, d)) continue;
    on_boundary = true;
    if (flips.At(p + d.offset())) builder.Add(p + d.offset());
  }
  if (on_boundary && flips.At(p)) builder.Remove(p);
}

}  // namespace

absl::StatusOr<Volume> WithBoundaryNoise(const Volume& object, double fraction, uint64_t seed) {
  const Flips flips(fraction, seed);
  const std::vector<BrickNeighborhood> neighbors = FindBrickNeighbors(object.keys());
  VolumeBuilder builder(object.extent(), object.placement());
  for (size_t n = 0; n < object.brick_count(); ++n) {
    builder.Brick(object.keys()[n]) = object.bricks()[n];
  }
  for (size_t n = 0; n < object.brick_count(); ++n) {
    const BrickSurroundings surroundings(object, static_cast<BrickIndex>(n), neighbors[n]);
    object.bricks()[n].ForEachSetBit(
        [&](int bit) { FlipAround(surroundings, bit, flips, builder); });
  }
  return std::move(builder).Build();
}

}  // namespace bccskel::shapes
