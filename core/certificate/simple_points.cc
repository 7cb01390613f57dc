#include <optional>

#include "core/certificate/brick_sum.h"
#include "core/certificate/certificate.h"
#include "core/certificate/neighbor_planes.h"
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

// Points that may have to be counted. A simple point lacks a neighbor, and one that is not an end
// point has two that are adjacent to each other.
HWY_INLINE Plane PossiblySimple(SimplePoints which, const Plane& own,
                                const Plane (&planes)[kNeighborCount]) {
  Plane adjacent_pair = AndNot(own, own), all = own;
  for (size_t a = 0; a < kNeighborCount; ++a) {
    for (size_t b = 0; b < a; ++b) {
      if (((kSharedNeighbors[a] >> b) & 1) == 0) continue;
      adjacent_pair = Or(adjacent_pair, And(planes[a], planes[b]));
    }
    all = And(all, planes[a]);
  }
  return AndNot(all, which == SimplePoints::kAll ? own : And(own, adjacent_pair));
}

HWY_INLINE int64_t CountAmong(const Plane& candidates, SimplePoints which, const BrickBits* spared,
                              const Plane (&planes)[kNeighborCount]) {
  BrickBits rest;
  StorePlane(candidates, rest);
  if (spared != nullptr) rest &= ~*spared;
  NeighborPlanes neighbors;
  for (size_t d = 0; d < kNeighborCount; ++d) StorePlane(planes[d], neighbors[d]);
  int64_t count = 0;
  rest.ForEachSetBit([&](int bit) {
    const NeighborMask around = NeighborsAt(bit, neighbors);
    count += (which == SimplePoints::kAll ? IsSimple(around) : IsSimpleNonEnd(around)) ? 1 : 0;
  });
  return count;
}

int64_t CountInBricksTarget(const Volume& object, SimplePoints which, const Volume& spared,
                            exec::Share share) {
  const BrickBits* bricks = object.padded_bricks().data();
  const BrickNeighborhood* neighbors = object.neighbors().data();
  int64_t count = 0;
  for (size_t n = share.begin; n < share.end; ++n) {
    const Plane own = LoadPlane(bricks[n]);
    Plane planes[kNeighborCount];
    AllPlanes(object.keys()[n].sublattice(), bricks, neighbors[n], own, planes);
    const Plane candidates = PossiblySimple(which, own, planes);
    if (IsEmpty(candidates)) continue;
    const std::optional<BrickIndex> at = spared.Find(object.keys()[n]);
    count +=
        CountAmong(candidates, which, at.has_value() ? &spared.bricks()[*at] : nullptr, planes);
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(CountInBricksTarget);

uint64_t CountSimplePoints(const Volume& object, SimplePoints which, const Volume& spared,
                           const exec::Context& context) {
  return static_cast<uint64_t>(
      SumOverBricks(context, object.brick_count(), [&](int, exec::Share batch) {
        return HWY_DYNAMIC_DISPATCH(CountInBricksTarget)(object, which, spared, batch);
      }));
}

}  // namespace bccskel
#endif  // HWY_ONCE
