#include "core/prepare/denoise.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>
#include <vector>

#include "core/certificate/brick_sum.h"
#include "core/lattice/directions.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/prepare/denoise.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"
// clang-format on

#ifndef BCCSKEL_CORE_PREPARE_DENOISE_ONCE_
#define BCCSKEL_CORE_PREPARE_DENOISE_ONCE_
namespace bccskel {
namespace {

// An object with room for the points that may join it.
struct RoomyObject {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;  // padded with one empty brick
  std::vector<BrickNeighborhood> neighbors;
};

struct PointChanges {
  int64_t added = 0;
  int64_t removed = 0;
};

}  // namespace
}  // namespace bccskel
#endif  // BCCSKEL_CORE_PREPARE_DENOISE_ONCE_

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

HWY_INLINE Plane Majority(const Plane& a, const Plane& b, const Plane& c) {
  return Or(And(a, b), And(c, Xor(a, b)));
}
// Leaves the sum's lowest bits in `a` and returns the carries.
HWY_INLINE Plane AddUp(Plane& a, const Plane& b, const Plane& c) {
  const Plane carries = Majority(a, b, c);
  a = Xor(Xor(a, b), c);
  return carries;
}

// The points at which at least 8 of the 15 bits are set.
HWY_INLINE Plane AtLeastEight(const Plane& own, const Plane (&p)[kNeighborCount]) {
  Plane a = p[0], b = p[3], c = p[6], d = p[9], e = p[12];
  Plane twos_a = AddUp(a, p[1], p[2]), twos_b = AddUp(b, p[4], p[5]);
  const Plane twos_c = AddUp(c, p[7], p[8]), twos_d = AddUp(d, p[10], p[11]);
  const Plane twos_e = AddUp(e, p[13], own), twos_f = AddUp(a, b, c), twos_g = AddUp(a, d, e);
  const Plane fours_a = AddUp(twos_a, twos_c, twos_d), fours_b = AddUp(twos_b, twos_e, twos_f);
  return Majority(fours_a, fours_b, Majority(twos_a, twos_b, twos_g));
}

PointChanges DenoiseBricksTarget(const RoomyObject& object, exec::Share share,
                                 std::span<BrickBits> out) {
  PointChanges changes;
  for (size_t n = share.begin; n < share.end; ++n) {
    const Plane own = LoadPlane(object.bricks[n]);
    Plane planes[kNeighborCount];
    AllPlanes(object.keys[n].sublattice(), object.bricks.data(), object.neighbors[n], own, planes);
    const Plane now = AtLeastEight(own, planes);
    changes.added += static_cast<int64_t>(CountBits(AndNot(own, now)));
    changes.removed += static_cast<int64_t>(CountBits(AndNot(now, own)));
    StorePlane(now, out[n]);
  }
  return changes;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {
namespace {

HWY_EXPORT(DenoiseBricksTarget);

bool IsInside(const LatticeExtent& extent, BrickCoordinates brick) {
  return brick.bx >= 0 && brick.by >= 0 && brick.bz >= 0 && brick.bx * kBrickX < extent.nx &&
         brick.by * kBrickY < extent.ny && brick.bz * kBrickZ < extent.nz;
}

// The bricks that are not stored but lie beside a stored brick of the other sublattice, increasing.
std::vector<BrickKey> MissingBricks(const Volume& object) {
  std::vector<BrickKey> missing;
  for (size_t n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates brick = object.keys()[n].coordinates();
    for (int position = 0; position < 8; ++position) {
      if (object.neighbors()[n][static_cast<size_t>(position)] < object.brick_count()) continue;
      const BrickCoordinates beside = NeighborBrick(brick, position);
      if (IsInside(object.extent(), beside)) missing.push_back(BrickKey(beside));
    }
  }
  std::ranges::sort(missing);
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  return missing;
}

RoomyObject WithRoom(const Volume& object) {
  const std::vector<BrickKey> missing = MissingBricks(object);
  RoomyObject roomy;
  roomy.keys.resize(object.brick_count() + missing.size());
  std::ranges::merge(object.keys(), missing, roomy.keys.begin());
  roomy.bricks.resize(roomy.keys.size() + 1);
  for (size_t n = 0, stored = 0; n < roomy.keys.size() && stored < object.brick_count(); ++n) {
    if (roomy.keys[n] == object.keys()[stored]) roomy.bricks[n] = object.bricks()[stored++];
  }
  roomy.neighbors = FindBrickNeighbors(roomy.keys);
  return roomy;
}

}  // namespace

absl::StatusOr<ChangedVolume> Denoise(const Volume& object, const exec::Context& context) {
  RoomyObject roomy = WithRoom(object);
  std::vector<BrickBits> bricks(roomy.keys.size());
  std::atomic<int64_t> removed = 0;
  const int64_t added = SumOverBricks(context, bricks.size(), [&](int, exec::Share batch) {
    const PointChanges changes = HWY_DYNAMIC_DISPATCH(DenoiseBricksTarget)(roomy, batch, bricks);
    removed += changes.removed;
    return changes.added;
  });
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  ChangedVolume changed;
  changed.points_added = static_cast<uint64_t>(added);
  changed.points_removed = static_cast<uint64_t>(removed.load());
  changed.object = Volume::FromSortedBricks(object.extent(), object.placement(),
                                            std::move(roomy.keys), std::move(bricks));
  return changed;
}

}  // namespace bccskel
#endif  // HWY_ONCE
