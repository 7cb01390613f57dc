#include "tests/quality/disturb.h"

#include <algorithm>
#include <random>
#include <vector>

#include "core/topology/simple_point_table.h"

namespace bccskel::quality {
namespace {

// An object whose points change, with room for one more layer.
class Clay {
 public:
  explicit Clay(const Volume& object)
      : size_{2 * object.extent().nx, 2 * object.extent().ny, 2 * object.extent().nz},
        bits_(static_cast<size_t>(size_[0]) * static_cast<size_t>(size_[1]) *
              static_cast<size_t>(size_[2])) {
    object.ForEachPoint([this](LatticePoint p) { bits_[IndexOf(p)] = true; });
  }

  bool Holds(LatticePoint p) const { return IsInside(p) && bits_[IndexOf(p)]; }
  bool IsInside(LatticePoint p) const {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size_[0] && p.y < size_[1] && p.z < size_[2];
  }
  NeighborMask NeighborsOf(LatticePoint p) const {
    NeighborMask mask = 0;
    for (int bit = 0; bit < kNeighborCount; ++bit) {
      const Direction d(bit);
      if (Holds(p + d.offset())) mask |= d.mask();
    }
    return mask;
  }
  void Flip(LatticePoint p) { bits_[IndexOf(p)] = !bits_[IndexOf(p)]; }

 private:
  size_t IndexOf(LatticePoint p) const {
    const auto at = [](int32_t v) { return static_cast<size_t>(v); };
    return (at(p.z) * at(size_[1]) + at(p.y)) * at(size_[0]) + at(p.x);
  }

  std::array<int32_t, 3> size_;
  std::vector<bool> bits_;
};

// The points on both sides of the boundary, in lattice order.
std::vector<LatticePoint> BoundaryOf(const Volume& object, const Clay& clay) {
  std::vector<LatticePoint> boundary;
  object.ForEachPoint([&](LatticePoint p) {
    const size_t before = boundary.size();
    for (const LatticePoint offset : kDirections14) {
      if (clay.IsInside(p + offset) && !clay.Holds(p + offset)) boundary.push_back(p + offset);
    }
    if (boundary.size() > before) boundary.push_back(p);
  });
  std::ranges::sort(boundary);
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  return boundary;
}

}  // namespace

Volume WithTopologyKeepingNoise(const Volume& object, double fraction, uint64_t seed) {
  Clay clay(object);
  std::vector<LatticePoint> boundary = BoundaryOf(object, clay);
  std::mt19937_64 random(seed);
  std::ranges::shuffle(boundary, random);
  boundary.resize(static_cast<size_t>(fraction * static_cast<double>(boundary.size())));
  VolumeBuilder builder(object.extent(), object.placement());
  object.ForEachPoint([&](LatticePoint p) { builder.Add(p); });
  for (const LatticePoint p : boundary) {
    if (!IsSimple(clay.NeighborsOf(p))) continue;
    clay.Flip(p);
    if (clay.Holds(p)) {
      builder.Add(p);
    } else {
      builder.Remove(p);
    }
  }
  return *std::move(builder).Build();
}

std::array<GridRotation, 24> GridRotations() {
  std::array<GridRotation, 24> rotations = {};
  size_t count = 0;
  std::array<int, 3> axis = {0, 1, 2};
  do {
    const bool even = (axis[1] - axis[0] + 3) % 3 == 1;  // the cyclic orders
    for (int signs = 0; signs < 8; ++signs) {
      const std::array<int, 3> sign = {signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1};
      if ((sign[0] * sign[1] * sign[2] == 1) == even) rotations[count++] = {axis, sign};
    }
  } while (std::ranges::next_permutation(axis).found);
  return rotations;
}

LatticePoint TurnOnGrid(LatticePoint p, const GridRotation& rotation) {
  const std::array<int32_t, 3> from = {p.x, p.y, p.z};
  const auto at = [&](size_t n) {
    return rotation.sign[n] * from[static_cast<size_t>(rotation.axis[n])];
  };
  return {at(0), at(1), at(2)};
}

LatticePoint TurnBackOnGrid(LatticePoint p, const GridRotation& rotation) {
  const std::array<int32_t, 3> from = {p.x, p.y, p.z};
  std::array<int32_t, 3> to = {};
  for (size_t n = 0; n < 3; ++n) {
    to[static_cast<size_t>(rotation.axis[n])] = rotation.sign[n] * from[n];
  }
  return {to[0], to[1], to[2]};
}

TurnedVolume TurnedOnGrid(const Volume& object, const GridRotation& rotation) {
  const LatticeExtent& extent = object.extent();
  const LatticePoint corner = TurnOnGrid({2 * extent.nx, 2 * extent.ny, 2 * extent.nz}, rotation);
  TurnedVolume turned;
  turned.shift = {std::max(-corner.x, 0), std::max(-corner.y, 0), std::max(-corner.z, 0)};
  VolumeBuilder builder(
      {std::abs(corner.x) / 2 + 1, std::abs(corner.y) / 2 + 1, std::abs(corner.z) / 2 + 1});
  object.ForEachPoint([&](LatticePoint p) { builder.Add(TurnOnGrid(p, rotation) + turned.shift); });
  turned.object = *std::move(builder).Build();
  return turned;
}

}  // namespace bccskel::quality
