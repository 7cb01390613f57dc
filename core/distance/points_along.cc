#include "core/distance/points_along.h"

#include <span>

#include "core/volume/brick.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/distance/points_along.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, PointsAlong::kCount>;
using Lanes = hn::Vec<Doubles>;

struct NearPoint {
  std::array<Lanes, 3> axes;
  Lanes squared;
};

// The nearest point of a sublattice. As PointNear() does it, step by step.
HWY_INLINE NearPoint NearestOf(double odd, const std::array<Lanes, 3>& at, const AxisScale& scale,
                               bool is_scaled) {
  const Doubles f64;
  const auto half = hn::Set(f64, 0.5), zero_at = hn::Set(f64, 1024), is_odd = hn::Set(f64, odd);
  NearPoint near;
  near.squared = hn::Zero(f64);
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto cell = hn::Mul(hn::Sub(at[axis], is_odd), half);
    const auto rounded = hn::Sub(hn::Trunc(hn::Add(cell, hn::Set(f64, 1024.5))), zero_at);
    const auto point = hn::Add(hn::Add(rounded, rounded), is_odd);
    auto off = hn::Sub(point, at[axis]);
    if (is_scaled) off = hn::Mul(hn::Set(f64, scale[axis]), off);
    near.axes[axis] = point;
    near.squared = hn::Add(near.squared, hn::Mul(off, off));
  }
  return near;
}

using Integers = hn::Rebind<int32_t, Doubles>;
using Points = std::array<hn::Vec<Integers>, 3>;  // by axis

HWY_INLINE Points PointsAt(const Lanes& along, const Coordinates& from, const Coordinates& way,
                           const AxisScale& scale, bool is_scaled) {
  const Doubles f64;
  std::array<Lanes, 3> at;
  for (size_t axis = 0; axis < 3; ++axis) {
    at[axis] = hn::Add(hn::Set(f64, from[axis]), hn::Mul(along, hn::Set(f64, way[axis])));
    if (is_scaled) at[axis] = hn::Div(at[axis], hn::Set(f64, scale[axis]));
  }
  const NearPoint even = NearestOf(0, at, scale, is_scaled);
  const NearPoint odd = NearestOf(1, at, scale, is_scaled);
  const auto is_even = hn::Le(even.squared, odd.squared);
  Points points;
  for (size_t axis = 0; axis < 3; ++axis) {
    points[axis] =
        hn::DemoteTo(Integers(), hn::IfThenElse(is_even, even.axes[axis], odd.axes[axis]));
  }
  return points;
}

void FindTarget(const Coordinates& from, const Coordinates& way, double first, double step,
                const AxisScale& scale, PointsAlong& points) {
  const Doubles f64;
  const bool is_scaled = scale != kIsotropic;
  for (size_t n = 0; n < PointsAlong::kCount; n += hn::Lanes(f64)) {
    const auto number = hn::Iota(f64, first + static_cast<double>(n));
    const Points near = PointsAt(hn::Mul(number, hn::Set(f64, step)), from, way, scale, is_scaled);
    for (size_t axis = 0; axis < 3; ++axis) {
      hn::StoreU(near[axis], Integers(), points.axes[axis].data() + n);
    }
  }
}

// Where points are stored, as AddressOf() has it.
struct Addresses {
  // The low ten bits of a brick's coordinates and its sublattice: bricks that have them in common
  // are 8192 units apart.
  alignas(64) std::array<uint32_t, PointsAlong::kCount> bricks;
  alignas(64) std::array<int32_t, PointsAlong::kCount> bits;
};

HWY_INLINE void StoreAddresses(const Points& p, Addresses& addresses) {
  const Integers i32;
  const hn::RebindToUnsigned<Integers> u32;
  const auto low = hn::Set(i32, 1023);
  const auto bx = hn::And(hn::ShiftRight<5>(p[0]), low);
  const auto by = hn::ShiftLeft<10>(hn::And(hn::ShiftRight<3>(p[1]), low));
  const auto bz = hn::ShiftLeft<20>(hn::And(hn::ShiftRight<4>(p[2]), low));
  const auto brick = hn::Or(hn::Or(bx, by), hn::Or(bz, hn::ShiftLeft<31>(p[0])));
  hn::StoreU(hn::BitCast(u32, brick), u32, addresses.bricks.data());
  const auto i = hn::And(hn::ShiftRight<1>(p[0]), hn::Set(i32, 15));
  const auto j = hn::And(hn::ShiftLeft<3>(p[1]), hn::Set(i32, 3 << 4));
  const auto k = hn::And(hn::ShiftLeft<5>(p[2]), hn::Set(i32, 7 << 6));
  hn::StoreU(hn::Or(i, hn::Or(j, k)), i32, addresses.bits.data());
}

// The two bricks that a line is in, one of each sublattice.
class BricksOnLine {
 public:
  BricksOnLine(const Volume& object, NearbyBricks& nearby)
      : bricks_(object.padded_bricks()), nearby_(nearby) {}

  HWY_INLINE bool Contain(const Points& points, const Addresses& addresses, size_t n) {
    const uint32_t brick = addresses.bricks[n];
    const size_t odd = brick >> 31;
    if (brick != known_[odd]) Find(points, brick, n);
    return bits_[odd]->Test(addresses.bits[n]);
  }

 private:
  HWY_NOINLINE void Find(const Points& points, uint32_t brick, size_t n) {
    std::array<std::array<int32_t, PointsAlong::kCount>, 3> at;
    for (size_t axis = 0; axis < 3; ++axis) hn::StoreU(points[axis], Integers(), at[axis].data());
    const size_t odd = brick >> 31;
    known_[odd] = brick;
    bits_[odd] = &bricks_[nearby_.Find(AddressOf({at[0][n], at[1][n], at[2][n]}).brick)];
  }

  std::span<const BrickBits> bricks_;
  NearbyBricks& nearby_;
  std::array<uint32_t, 2> known_ = {1u << 31, 0};  // those of the other sublattice: none
  std::array<const BrickBits*, 2> bits_ = {};
};

double WayInObjectTarget(const Volume& object, NearbyBricks& nearby, const Coordinates& from,
                         const Coordinates& way, double start, double reach,
                         const AxisScale& scale) {
  const Doubles f64;
  const bool is_scaled = scale != kIsotropic;
  BricksOnLine bricks(object, nearby);
  Addresses addresses;
  bool missing = false;  // the point before
  double out = start;
  for (double next = start + 1; missing || out < reach;
       next += static_cast<double>(hn::Lanes(f64))) {
    const Points points = PointsAt(hn::Iota(f64, next), from, way, scale, is_scaled);
    StoreAddresses(points, addresses);
    for (size_t n = 0; n < hn::Lanes(f64); ++n) {
      if (!missing && out >= reach) return out;
      const bool is_in = bricks.Contain(points, addresses, n);
      if (missing && !is_in) return out;
      if (is_in) out += missing ? 2 : 1;
      missing = !is_in;
    }
  }
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindTarget);
HWY_EXPORT(WayInObjectTarget);

PointsAlong FindPointsAlong(const Coordinates& from, const Coordinates& way, double first,
                            double step, const AxisScale& scale) {
  PointsAlong points;
  HWY_DYNAMIC_DISPATCH(FindTarget)(from, way, first, step, scale, points);
  return points;
}

double WayInObject(const Volume& object, NearbyBricks& nearby, const Coordinates& from,
                   const Coordinates& way, double start, double reach, const AxisScale& scale) {
  return HWY_DYNAMIC_DISPATCH(WayInObjectTarget)(object, nearby, from, way, start, reach, scale);
}

}  // namespace bccskel
#endif  // HWY_ONCE
