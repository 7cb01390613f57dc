#include <array>
#include <bit>

#include "core/certificate/brick_sum.h"
#include "core/certificate/certificate.h"
#include "core/topology/neighborhood.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/certificate/simple_points.cc"
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

// Points that may satisfy Conditions 1 and 2. More than one neighbor in one component means that
// two neighbors are adjacent to each other; one background component, that one is missing.
HWY_INLINE Plane PossiblySimple(const Plane& own, const Plane (&planes)[kNeighborCount]) {
  Plane adjacent_pair = AndNot(own, own), all = own;
  for (size_t a = 0; a < kNeighborCount; ++a) {
    for (size_t b = 0; b < a; ++b) {
      if (((kSharedNeighbors[a] >> b) & 1) == 0) continue;
      adjacent_pair = Or(adjacent_pair, And(planes[a], planes[b]));
    }
    all = And(all, planes[a]);
  }
  return AndNot(all, And(own, adjacent_pair));
}

HWY_INLINE int64_t CountAmong(const Plane& candidates, const Plane (&planes)[kNeighborCount]) {
  if (IsEmpty(candidates)) return 0;
  BrickBits rest;
  StorePlane(candidates, rest);
  std::array<BrickBits, kNeighborCount> neighbors;
  for (size_t d = 0; d < kNeighborCount; ++d) StorePlane(planes[d], neighbors[d]);
  int64_t count = 0;
  rest.ForEachSetBit([&](int bit) {
    unsigned mask = 0;
    for (size_t d = 0; d < kNeighborCount; ++d) mask |= (neighbors[d].Test(bit) ? 1u : 0u) << d;
    count += IsSimpleNonEnd(static_cast<NeighborMask>(mask)) ? 1 : 0;
  });
  return count;
}

int64_t CountInBricksTarget(const Volume& object, exec::Share share) {
  const BrickBits* bricks = object.padded_bricks().data();
  const BrickNeighborhood* neighbors = object.neighbors().data();
  int64_t count = 0;
  for (size_t n = share.begin; n < share.end; ++n) {
    const Plane own = LoadPlane(bricks[n]);
    Plane planes[kNeighborCount];
    if ((object.keys()[n].value() & 1) == 0) {
      AllPlanes<Sublattice::kEven>(bricks, neighbors[n], own, planes);
    } else {
      AllPlanes<Sublattice::kOdd>(bricks, neighbors[n], own, planes);
    }
    count += CountAmong(PossiblySimple(own, planes), planes);
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(CountInBricksTarget);

uint64_t CountSimpleNonEndPoints(const Volume& object, const exec::Context& context) {
  return static_cast<uint64_t>(
      SumOverBricks(context, object.brick_count(), [&](int, exec::Share batch) {
        return HWY_DYNAMIC_DISPATCH(CountInBricksTarget)(object, batch);
      }));
}

}  // namespace bccskel
#endif  // HWY_ONCE
