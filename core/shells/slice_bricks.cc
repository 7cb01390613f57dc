#include "core/shells/slice_bricks.h"

#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/shells/slice_bricks.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Writes the shell modulo 64 of each point as a byte.
HWY_INLINE void WriteShellBytes(const FloatShellRule& rule, const uint16_t* distances,
                                uint8_t* shells) {
  const hn::CappedTag<float, 16> f32;
  const hn::RebindToSigned<decltype(f32)> i32;
  const hn::Rebind<uint16_t, decltype(f32)> u16;
  const hn::Rebind<uint8_t, decltype(f32)> u8;
  const auto scale = hn::Set(f32, rule.scale), offset = hn::Set(f32, rule.offset);
  const auto one = hn::Set(i32, 1), modulo = hn::Set(i32, 63);
  for (size_t n = 0; n < kBrickPoints; n += hn::Lanes(f32)) {
    const auto distance = hn::ConvertTo(f32, hn::PromoteTo(i32, hn::LoadU(u16, distances + n)));
    // Rounds twice on purpose: a fused operation would differ between machines.
    const auto shell = hn::ConvertTo(i32, hn::Add(hn::Mul(distance, scale), offset));
    hn::Store(hn::DemoteTo(u8, hn::And(hn::Max(shell, one), modulo)), u8, shells + n);
  }
}

template <size_t kCount>
HWY_INLINE void WritePlanes(const uint8_t* shells, std::array<BrickBits, kCount>& planes) {
  const hn::CappedTag<uint8_t, 64> u8;
  const size_t lanes = hn::Lanes(u8);
  for (size_t b = 0; b < kCount; ++b) {
    const auto bit = hn::Set(u8, static_cast<uint8_t>(1u << b));
    auto* bytes = reinterpret_cast<uint8_t*>(planes[b].words.data());
    if (lanes < 8) {  // no vectors: collect single bits
      planes[b] = BrickBits();
      for (int n = 0; n < kBrickPoints; ++n) {
        if ((shells[n] >> b & 1) != 0) planes[b].Set(n);
      }
      continue;
    }
    for (size_t n = 0; n < kBrickPoints; n += lanes) {
      hn::StoreMaskBits(u8, hn::TestBit(hn::Load(u8, shells + n), bit), bytes + n / 8);
    }
  }
}

HWY_INLINE DistanceRange RangeOf(const uint16_t* distances) {
  const hn::CappedTag<uint16_t, 32> u16;
  const auto one = hn::Set(u16, 1);
  auto smallest = hn::Set(u16, 0xffff), largest = hn::Zero(u16);
  for (size_t n = 0; n < kBrickPoints; n += hn::Lanes(u16)) {
    const auto distance = hn::LoadU(u16, distances + n);
    smallest = hn::Min(smallest, hn::Sub(distance, one));  // zero wraps to the largest value
    largest = hn::Max(largest, distance);
  }
  alignas(64) uint16_t low[32], high[32];
  hn::Store(smallest, u16, low);
  hn::Store(largest, u16, high);
  DistanceRange range = {0xffff, 0};
  for (size_t n = 0; n < hn::Lanes(u16); ++n) {
    if (low[n] < range.smallest) range.smallest = low[n];
    if (high[n] > range.largest) range.largest = high[n];
  }
  if (range.smallest != 0xffff) ++range.smallest;
  return range;
}

DistanceRange SliceBrickTarget(const FloatShellRule& rule, const uint16_t* distances,
                               ShellPlanes& planes) {
  alignas(64) uint8_t shells[kBrickPoints];
  WriteShellBytes(rule, distances, shells);
  WritePlanes(shells, planes);
  return RangeOf(distances);
}

using Floats = hn::CappedTag<float, 16>;
HWY_INLINE hn::Vec<Floats> LoadSquares(const float* squared) {
  return hn::LoadU(Floats(), squared);
}
HWY_INLINE hn::Vec<Floats> LoadSquares(const uint16_t* squared) {
  const hn::RebindToSigned<Floats> i32;
  const hn::Rebind<uint16_t, Floats> u16;
  return hn::ConvertTo(Floats(), hn::PromoteTo(i32, hn::LoadU(u16, squared)));
}

// A multiplication replaces the division by a power of two, with the same bits.
struct Slicer {
  explicit Slicer(const EuclideanShellRule& rule)
      : width(rule.width()), multiplies(std::bit_cast<uint32_t>(width) << 9 == 0) {}

  // The shell modulo 64 of points at these distances.
  HWY_INLINE hn::Vec<hn::Rebind<uint8_t, Floats>> operator()(hn::Vec<Floats> distance) const {
    const Floats f32;
    const hn::RebindToSigned<Floats> i32;
    const hn::Rebind<uint8_t, Floats> u8;
    const auto shells = multiplies ? hn::Mul(distance, hn::Set(f32, 1 / width))
                                   : hn::Div(distance, hn::Set(f32, width));
    const auto shell = hn::ConvertTo(i32, hn::Add(shells, hn::Set(f32, 0.5f)));
    return hn::DemoteTo(u8, hn::And(hn::Max(shell, hn::Set(i32, 1)), hn::Set(i32, 63)));
  }

  float width;
  bool multiplies;
};

HWY_INLINE SquaredRange RangeOfSquares(const float* squared) {
  const Floats f32;
  const auto far = hn::Set(f32, std::numeric_limits<float>::infinity()), zero = hn::Zero(f32);
  auto smallest = far, largest = zero;
  for (size_t n = 0; n < kBrickPoints; n += hn::Lanes(f32)) {
    const auto value = hn::LoadU(f32, squared + n);
    smallest = hn::Min(smallest, hn::IfThenElse(hn::Eq(value, zero), far, value));
    largest = hn::Max(largest, value);
  }
  alignas(64) float low[16], high[16];
  hn::Store(smallest, f32, low);
  hn::Store(largest, f32, high);
  SquaredRange range = {low[0], high[0]};
  for (size_t n = 1; n < hn::Lanes(f32); ++n) {
    if (low[n] < range.smallest) range.smallest = low[n];
    if (high[n] > range.largest) range.largest = high[n];
  }
  return range;
}

HWY_INLINE SquaredRange RangeOfSquares(const uint16_t* squared) {
  const DistanceRange range = RangeOf(squared);
  return {static_cast<float>(range.smallest), static_cast<float>(range.largest)};
}

template <typename T>
HWY_INLINE SquaredRange SliceSquares(const SquareRules& rules, const T* squared,
                                     ShellPlanes& planes, DepthPlanes* depth_planes) {
  const Floats f32;
  const hn::Rebind<uint8_t, Floats> u8;
  const Slicer shell(rules.shell), depth(rules.depth);
  alignas(64) uint8_t shells[kBrickPoints], depths[kBrickPoints];
  for (size_t n = 0; n < kBrickPoints; n += hn::Lanes(f32)) {
    const auto distance = hn::Sqrt(LoadSquares(squared + n));
    hn::Store(shell(distance), u8, shells + n);
    if (depth_planes != nullptr) hn::Store(depth(distance), u8, depths + n);
  }
  WritePlanes(shells, planes);
  if (depth_planes != nullptr) WritePlanes(depths, *depth_planes);
  return RangeOfSquares(squared);
}
SquaredRange SliceSquaredTarget(const SquareRules& rules, const float* squared, ShellPlanes& planes,
                                DepthPlanes* depths) {
  return SliceSquares(rules, squared, planes, depths);
}
SquaredRange SliceWholeSquaredTarget(const SquareRules& rules, const uint16_t* squared,
                                     ShellPlanes& planes, DepthPlanes* depths) {
  return SliceSquares(rules, squared, planes, depths);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {
namespace {

int32_t Apply(const FloatShellRule& rule, uint32_t distance) {
  const float scaled = static_cast<float>(distance) * rule.scale;
  const auto shell = static_cast<int32_t>(scaled + rule.offset);
  return shell < 1 ? 1 : shell;
}

}  // namespace

HWY_EXPORT(SliceBrickTarget);
HWY_EXPORT(SliceSquaredTarget);
HWY_EXPORT(SliceWholeSquaredTarget);

DistanceRange SliceBrick(const FloatShellRule& rule, const uint16_t* distances,
                         ShellPlanes& planes) {
  return HWY_DYNAMIC_DISPATCH(SliceBrickTarget)(rule, distances, planes);
}

SquaredRange SliceBrick(const SquareRules& rules, const float* squared, ShellPlanes& planes,
                        DepthPlanes* depths) {
  return HWY_DYNAMIC_DISPATCH(SliceSquaredTarget)(rules, squared, planes, depths);
}

SquaredRange SliceBrick(const SquareRules& rules, const uint16_t* squared, ShellPlanes& planes,
                        DepthPlanes* depths) {
  return HWY_DYNAMIC_DISPATCH(SliceWholeSquaredTarget)(rules, squared, planes, depths);
}

CheckedFloatRule MakeFloatRule(const ShellRule& exact, uint32_t largest) {
  // Borders lie at multiples of 1/256 count; an offset of half of that keeps integer distances away
  // from them.
  const double width = static_cast<double>(exact.width()) / 128;
  const FloatShellRule rule = {static_cast<float>(1 / width),
                               static_cast<float>(0.5 + 1.0 / 512 / width)};
  for (int32_t shell = 2;; ++shell) {
    // The first distance of this shell: 256 * distance >= (2 * shell - 1) * width.
    const uint64_t border = (2 * static_cast<uint64_t>(shell) - 1) * exact.width();
    const uint64_t first = (border + 255) / 256;
    if (first > largest) return {rule, Apply(rule, largest) == exact(largest)};
    const auto distance = static_cast<uint32_t>(first);
    if (Apply(rule, distance) != shell || Apply(rule, distance - 1) != shell - 1) {
      return {rule, false};
    }
  }
}

}  // namespace bccskel
#endif  // HWY_ONCE
