#include "core/distance/points_along.h"

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

// The nearest point of a sublattice, with the bits of PointNear(): halves and whole numbers are
// exact.
template <bool kScaled>
HWY_INLINE NearPoint NearestOf(double odd, const std::array<Lanes, 3>& at, const AxisScale& scale) {
  const Doubles f64;
  NearPoint near;
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto cell = hn::Sub(hn::Mul(at[axis], hn::Set(f64, 0.5)), hn::Set(f64, odd / 2));
    const auto rounded = hn::Trunc(hn::Add(cell, hn::Set(f64, 1024.5)));
    const auto point = hn::Add(hn::Add(rounded, rounded), hn::Set(f64, odd - 2 * 1024));
    auto off = hn::Sub(point, at[axis]);
    if (kScaled) off = hn::Mul(hn::Set(f64, scale[axis]), off);
    const auto squared = hn::Mul(off, off);
    near.axes[axis] = point;
    near.squared = axis == 0 ? squared : hn::Add(near.squared, squared);
  }
  return near;
}

template <bool kScaled>
HWY_INLINE void FindPoints(const Coordinates& from, const Coordinates& way, double first,
                           double step, const AxisScale& scale, PointsAlong& points) {
  const Doubles f64;
  const hn::Rebind<int32_t, Doubles> i32;
  for (size_t n = 0; n < PointsAlong::kCount; n += hn::Lanes(f64)) {
    const auto number = hn::Iota(f64, first + static_cast<double>(n));
    const auto along = hn::Mul(number, hn::Set(f64, step));
    std::array<Lanes, 3> at;
    for (size_t axis = 0; axis < 3; ++axis) {
      at[axis] = hn::Add(hn::Set(f64, from[axis]), hn::Mul(along, hn::Set(f64, way[axis])));
      if (kScaled) at[axis] = hn::Div(at[axis], hn::Set(f64, scale[axis]));
    }
    const NearPoint even = NearestOf<kScaled>(0, at, scale);
    const NearPoint odd = NearestOf<kScaled>(1, at, scale);
    const auto is_even = hn::Le(even.squared, odd.squared);
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto nearer = hn::IfThenElse(is_even, even.axes[axis], odd.axes[axis]);
      hn::StoreU(hn::DemoteTo(i32, nearer), i32, points.axes[axis].data() + n);
    }
  }
}

void FindTarget(const Coordinates& from, const Coordinates& way, double first, double step,
                const AxisScale& scale, PointsAlong& points) {
  if (scale == kIsotropic) {
    FindPoints<false>(from, way, first, step, scale, points);
  } else {
    FindPoints<true>(from, way, first, step, scale, points);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindTarget);

PointsAlong FindPointsAlong(const Coordinates& from, const Coordinates& way, double first,
                            double step, const AxisScale& scale) {
  PointsAlong points;
  HWY_DYNAMIC_DISPATCH(FindTarget)(from, way, first, step, scale, points);
  return points;
}

}  // namespace bccskel
#endif  // HWY_ONCE
