#include "core/certificate/brick_components.h"

#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/certificate/brick_components.cc"
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

HWY_INLINE bool HasOnePoint(const Plane& points) {
  const BrickTag tag;
  const BrickLane one = hn::Set(tag, 1);
  BrickLane more = hn::Zero(tag);
  size_t words = 0;
  for (size_t n = 0; n < kVectors; ++n) {
    more = hn::Or(more, hn::And(points.v[n], hn::Sub(points.v[n], one)));
    words += hn::CountTrue(tag, hn::Ne(points.v[n], hn::Zero(tag)));
  }
  return words == 1 && hn::AllTrue(tag, hn::Eq(more, hn::Zero(tag)));
}

// From every point, walk against the signs sx, sy, sz as long as there is a neighbor: all walks end
// at points without a neighbor in those directions. If there is only one such point, all are
// connected to it. For the signs of its surface normal, the part of a smooth object in a brick
// passes the test.
HWY_INLINE bool IsPlainlyConnected(const Plane& points) {
  const Plane beyond = None();
  const Plane x[2] = {StepX<Step::kDown>(points, beyond), StepX<Step::kUp>(points, beyond)};
  const Plane y[2] = {StepY<Step::kDown>(points, beyond), StepY<Step::kUp>(points, beyond)};
  const Plane z[2] = {StepZ<Step::kDown>(points, beyond), StepZ<Step::kUp>(points, beyond)};
  for (size_t signs = 0; signs < 8; ++signs) {
    const Plane near = Or(x[signs & 1], Or(y[(signs >> 1) & 1], z[signs >> 2]));
    if (HasOnePoint(AndNot(near, points))) return true;
  }
  return false;
}

void TestConnectivityTarget(std::span<const BrickBits> bricks, Phase phase,
                            std::span<BrickBits> points, std::span<Connectivity> found) {
  const Plane flip = Repeat(phase == Phase::kObject ? 0 : ~uint64_t{0});
  for (size_t n = 0; n < bricks.size(); ++n) {
    const Plane some = Xor(LoadPlane(bricks[n]), flip);
    StorePlane(some, points[n]);
    found[n] = IsEmpty(some)              ? Connectivity::kEmpty
               : IsPlainlyConnected(some) ? Connectivity::kConnected
                                          : Connectivity::kUnclear;
  }
}

void FloodTarget(BrickBits& seed, const BrickBits& open) {
  const Plane among = LoadPlane(open), beyond = None();
  Plane reached = LoadPlane(seed);
  for (;;) {
    const Plane x = Or(StepX<Step::kDown>(reached, beyond), StepX<Step::kUp>(reached, beyond));
    const Plane y = Or(StepY<Step::kDown>(reached, beyond), StepY<Step::kUp>(reached, beyond));
    const Plane z = Or(StepZ<Step::kDown>(reached, beyond), StepZ<Step::kUp>(reached, beyond));
    const Plane fresh = AndNot(reached, And(Or(x, Or(y, z)), among));
    if (IsEmpty(fresh)) break;
    reached = Or(reached, fresh);
  }
  StorePlane(reached, seed);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(TestConnectivityTarget);
HWY_EXPORT(FloodTarget);

namespace {

// The component of `seed` in `open`.
BrickBits Flood(const BrickBits& seed, const BrickBits& open) {
  BrickBits component = seed;
  HWY_DYNAMIC_DISPATCH(FloodTarget)(component, open);
  return component;
}

BrickBits FirstPoint(const BrickBits& points) {
  BrickBits first;
  for (size_t k = 0; k < 8; ++k) {
    if (points.words[k] == 0) continue;
    first.words[k] = points.words[k] & (~points.words[k] + 1);
    break;
  }
  return first;
}

std::vector<BrickBits> FindComponents(const BrickBits& points) {
  std::vector<BrickBits> components;
  for (BrickBits rest = points; !rest.Empty();) {
    components.push_back(Flood(FirstPoint(rest), rest));
    rest &= ~components.back();
  }
  return components;
}

size_t LargestOf(const std::vector<BrickBits>& components) {
  size_t largest = 0;
  uint64_t points = 0;
  for (size_t n = 0; n < components.size(); ++n) {
    const uint64_t count = components[n].Count();
    if (count > points) {
      largest = n;
      points = count;
    }
  }
  return largest;
}

}  // namespace

void TestConnectivity(std::span<const BrickBits> bricks, Phase phase, std::span<BrickBits> points,
                      std::span<Connectivity> found) {
  HWY_DYNAMIC_DISPATCH(TestConnectivityTarget)(bricks, phase, points, found);
}

bool IsConnected(const BrickBits& points) { return Flood(FirstPoint(points), points) == points; }

BrickFragments SplitBrick(const BrickBits& points) {
  const std::vector<BrickBits> components = FindComponents(points);
  const size_t main = LargestOf(components);
  BrickFragments split;
  split.fragments = points & ~components[main];
  split.components = static_cast<int>(components.size());
  uint8_t label = 0;
  for (size_t n = 0; n < components.size(); ++n) {
    if (n == main) continue;
    ++label;
    components[n].ForEachSetBit([&](int bit) { split.labels[static_cast<size_t>(bit)] = label; });
  }
  return split;
}

}  // namespace bccskel
#endif  // HWY_ONCE
