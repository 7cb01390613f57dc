#include "core/volume/count_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/volume/count_points.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

uint64_t CountPointsTarget(std::span<const BrickBits> bricks) {
  uint64_t count = 0;
  for (const BrickBits& brick : bricks) count += CountBits(LoadPlane(brick));
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(CountPointsTarget);

uint64_t CountPoints(std::span<const BrickBits> bricks) {
  return HWY_DYNAMIC_DISPATCH(CountPointsTarget)(bricks);
}

}  // namespace bccskel
#endif  // HWY_ONCE
