#ifndef BCCSKEL_CORE_DISTANCE_PLACES_H_
#define BCCSKEL_CORE_DISTANCE_PLACES_H_

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/base/attributes.h"
#include "core/distance/chamfer_weights.h"
#include "core/lattice/directions.h"
#include "core/volume/volume.h"

namespace bccskel {

// A position between lattice points, or the vector from one to another, in lattice units along the
// axes of the lattice, so stretched where spacings differ.
using Coordinates = Vector3<double>;

// Two unit vectors perpendicular to `way` and to each other. Needs: `way` has length 1.
inline std::array<Coordinates, 2> Across(const Coordinates& way) {
  const auto least = std::ranges::min_element(way, {}, [](double v) { return std::abs(v); });
  Coordinates axis = {0, 0, 0};
  axis[static_cast<size_t>(least - way.begin())] = 1;
  const Coordinates u = Unit(Cross(way, axis));
  return {u, Cross(way, u)};
}

inline Coordinates PlaceOf(LatticePoint p, const AxisScale& scale) {
  return {scale[0] * p.x, scale[1] * p.y, scale[2] * p.z};
}

inline Coordinates WayBetween(LatticePoint from, LatticePoint to, const AxisScale& scale) {
  return Sum(PlaceOf(to, scale), -1, PlaceOf(from, scale));
}

// Factor for the steps of walks through the object. Where an axis is more than 16 times as long as
// the shortest, steps of a unit would only repeat points.
inline double CoarsenessOf(const AxisScale& scale) {
  return std::max(1.0, std::ranges::max(scale) / 16);
}

// Euclidean distance in lattice units.
inline double StraightDistance(LatticePoint a, LatticePoint b, const AxisScale& scale) {
  const double x = scale[0] * (a.x - b.x), y = scale[1] * (a.y - b.y), z = scale[2] * (a.z - b.z);
  return std::sqrt(x * x + y * y + z * z);
}

// The nearest integer. Needs: v > -1024. Avoids the library call, which depends on the rounding
// mode.
inline int32_t Rounded(double v) { return static_cast<int32_t>(v + 1024.5) - 1024; }

// The integer below. Avoids the library call.
inline int32_t FloorOf(double v) {
  const auto toward_zero = static_cast<int32_t>(v);
  return v < toward_zero ? toward_zero - 1 : toward_zero;
}

// A lattice point next to the position, the nearest one if spacings are equal. It may lie outside
// the extent. Needs: no coordinate below -2000.
inline LatticePoint PointNear(const Coordinates& place, const AxisScale& scale) {
  const auto near = [&place](const AxisScale& unit) -> LatticePoint {
    std::array<std::array<int32_t, 3>, 2> best;
    std::array<double, 2> squares = {0, 0};
    for (int32_t odd : {0, 1}) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const double at = place[axis] / unit[axis];
        const int32_t point = 2 * Rounded((at - odd) / 2) + odd;
        const double off = unit[axis] * (point - at);
        best[static_cast<size_t>(odd)][axis] = point;
        squares[static_cast<size_t>(odd)] += off * off;
      }
    }
    const auto& [x, y, z] = best[squares[0] <= squares[1] ? 0 : 1];
    return {x, y, z};
  };
  // The compiler removes divisions by a constant 1.
  return scale == kIsotropic ? near(kIsotropic) : near(scale);
}

// Finds the bricks of points that lie close together. Caches earlier results, all of them if the
// extent has few bricks. Memory depends on the number of bricks, not on the extent.
class NearbyBricks {
 public:
  // Needs: `object` outlives this.
  explicit NearbyBricks(const Volume& object)
      : object_(object),
        window_(object.window()),
        slots_(BitsFor(object)),
        found_(slots_.count, Found{BrickKey(), none()}) {}

  BrickIndex none() const { return static_cast<BrickIndex>(object_.brick_count()); }

  // The index of the brick; none(), the padding brick, if it is not stored.
  ABSL_ATTRIBUTE_ALWAYS_INLINE BrickIndex Find(const BrickCoordinates& brick) {
    const BrickKey key(brick);
    Found& found = found_[slots_.Of(key)];
    if (found.key != key) {
      found = {key, object_.Find(key).value_or(none())};
    }
    return found.brick;
  }

  // As Volume::Contains(): no bricks lie outside the extent, and those at its end have no points
  // outside it. Returns true outside the object's window, if it has one.
  // Needs: a lattice point less than 2^20 units outside the extent.
  ABSL_ATTRIBUTE_ALWAYS_INLINE bool Contains(LatticePoint p) {
    if (window_.has_value() && !window_->Contains(p)) return true;
    const BrickAddress address = AddressOf(p);
    return object_.padded_bricks()[Find(address.brick)].Test(address.bit);
  }

  // How many of the 14 neighbors it contains. Needs: as Contains().
  int NeighborsOf(LatticePoint p) {
    return static_cast<int>(std::ranges::count_if(
        kDirections14, [&](LatticePoint offset) { return Contains(p + offset); }));
  }

 private:
  struct Found {
    BrickKey key;  // the default belongs to no brick
    BrickIndex brick = 0;
  };

  // The slot of a brick consists of the low bits of its coordinates and its sublattice. If enough
  // bits are available, all bricks of the extent have different slots.
  struct Bits {
    int x = 1, y = 1, z = 1;

    int All() const { return x + y + z + 1; }
  };
  static Bits BitsFor(const Volume& object) {
    const LatticeExtent& extent = object.extent();
    const auto bits_for = [](int32_t cells, int32_t length) {
      return static_cast<int>(
          std::bit_width(static_cast<uint32_t>(std::max(cells - 1, 0) / length)));
    };
    Bits bits = {bits_for(extent.nx, kBrickX), bits_for(extent.ny, kBrickY),
                 bits_for(extent.nz, kBrickZ)};
    // At least eight slots per brick, since bricks that are not stored are looked up, too.
    const int most = std::clamp(static_cast<int>(std::bit_width(object.brick_count())) + 3, 6, 13);
    while (bits.All() > most)
      --(bits.x >= std::max(bits.y, bits.z) ? bits.x : bits.y >= bits.z ? bits.y : bits.z);
    return bits;
  }

  // Gathers those bits of a key by a product, which shifts x and y up to z; others drop out.
  struct Slots {
    explicit Slots(const Bits& bits)
        : count(size_t{1} << bits.All()),
          low(BrickKey({(1 << bits.x) - 2, (1 << bits.y) - 2, (1 << bits.z) - 2, Sublattice::kOdd})
                  .value()),
          factor(1 | uint64_t{1} << (BrickKey::kAtZ - BrickKey::kAtY + bits.z) |
                 uint64_t{1} << (BrickKey::kAtZ + bits.z + bits.y)) {}

    size_t Of(BrickKey key) const { return ((key.value() & low) * factor) >> BrickKey::kAtZ; }

    size_t count;
    uint64_t low, factor;
  };

  const Volume& object_;
  const std::optional<LatticeBox> window_;
  const Slots slots_;
  std::vector<Found> found_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_PLACES_H_
