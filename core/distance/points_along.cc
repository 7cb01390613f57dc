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

template <class D>
struct NearPoint {
  std::array<hn::Vec<D>, 3> axes;
  hn::Vec<D> squared;
};

// The nearest point of a sublattice, with the bits of PointNear(): halves and whole numbers are
// exact.
template <bool kScaled, class D, class V = hn::Vec<D>>
HWY_INLINE NearPoint<D> NearestOf(D f64, double odd, const std::array<V, 3>& at,
                                  const AxisScale& scale) {
  NearPoint<D> near;
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

// Stores the points next to from + along * way at position n.
template <bool kScaled, size_t kPoints, class D, class V = hn::Vec<D>>
HWY_INLINE void StorePoints(D f64, const Coordinates& from, const Coordinates& way, V along,
                            const AxisScale& scale, size_t n, PointsOnLine<kPoints>& points) {
  const hn::Rebind<int32_t, D> i32;
  std::array<V, 3> at;
  for (size_t axis = 0; axis < 3; ++axis) {
    at[axis] = hn::Add(hn::Set(f64, from[axis]), hn::Mul(along, hn::Set(f64, way[axis])));
    if (kScaled) at[axis] = hn::Div(at[axis], hn::Set(f64, scale[axis]));
  }
  const NearPoint<D> even = NearestOf<kScaled>(f64, 0, at, scale);
  const NearPoint<D> odd = NearestOf<kScaled>(f64, 1, at, scale);
  const auto is_even = hn::Le(even.squared, odd.squared);
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto nearer = hn::IfThenElse(is_even, even.axes[axis], odd.axes[axis]);
    hn::StoreU(hn::DemoteTo(i32, nearer), i32, points.axes[axis].data() + n);
  }
}

template <bool kScaled>
HWY_INLINE void FindPoints(const Coordinates& from, const Coordinates& way, double first,
                           double step, const AxisScale& scale, PointsAlong& points) {
  const hn::CappedTag<double, PointsAlong::kCount> f64;
  for (size_t n = 0; n < PointsAlong::kCount; n += hn::Lanes(f64)) {
    const auto number = hn::Iota(f64, first + static_cast<double>(n));
    const auto along = hn::Mul(number, hn::Set(f64, step));
    StorePoints<kScaled>(f64, from, way, along, scale, n, points);
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

template <bool kScaled>
HWY_INLINE void FindToBothSides(const Coordinates& from, const Coordinates& way, double out,
                                const AxisScale& scale, PointsOnLine<4>& points) {
  const hn::CappedTag<double, 4> f64;
  alignas(32) const std::array<double, 4> along = {out, out + 1, -out, -out - 1};
  for (size_t n = 0; n < along.size(); n += hn::Lanes(f64)) {
    StorePoints<kScaled>(f64, from, way, hn::Load(f64, along.data() + n), scale, n, points);
  }
}

void BothSidesTarget(const Coordinates& from, const Coordinates& way, double out,
                     const AxisScale& scale, PointsOnLine<4>& points) {
  if (scale == kIsotropic) {
    FindToBothSides<false>(from, way, out, scale, points);
  } else {
    FindToBothSides<true>(from, way, out, scale, points);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindTarget);
HWY_EXPORT(BothSidesTarget);

PointsAlong FindPointsAlong(const Coordinates& from, const Coordinates& way, double first,
                            double step, const AxisScale& scale) {
  PointsAlong points;
  HWY_DYNAMIC_DISPATCH(FindTarget)(from, way, first, step, scale, points);
  return points;
}

PointsOnLine<4> FindPointsToBothSides(const Coordinates& from, const Coordinates& way, double out,
                                      const AxisScale& scale) {
  PointsOnLine<4> points;
  HWY_DYNAMIC_DISPATCH(BothSidesTarget)(from, way, out, scale, points);
  return points;
}

}  // namespace bccskel
#endif  // HWY_ONCE
