#include "core/certificate/neighbor_planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/certificate/neighbor_planes.cc"
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

void FindNeighborPlanesTarget(Sublattice sublattice, const BrickSurroundings& bricks,
                              NeighborPlanes& planes) {
  constexpr BrickNeighborhood kSideBySide = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
  Plane all[kNeighborCount];
  AllPlanes(sublattice, bricks.around.data(), kSideBySide, LoadPlane(bricks.own), all);
  for (size_t d = 0; d < kNeighborCount; ++d) StorePlane(all[d], planes[d]);
}

template <int kAxis, Step kStep>
HWY_INLINE Plane StepAlong(const Plane& own, const Plane& next) {
  if constexpr (kAxis == 0) return StepX<kStep>(own, next);
  if constexpr (kAxis == 1) return StepY<kStep>(own, next);
  if constexpr (kAxis == 2) return StepZ<kStep>(own, next);
}

// The cells that have a neighbor in the brick of the other sublattice that lies one brick away
// along the axes in kAway. Along such an axis the neighbor is one cell further; along the others it
// has the same index or is one cell further.
template <int kAway, Step kStep, int kAxis = 0>
HWY_INLINE Plane CellsThatSee(const Plane& brick) {
  if constexpr (kAxis == 3) {
    return brick;
  } else {
    const Plane seen = CellsThatSee<kAway, kStep, kAxis + 1>(brick);
    if constexpr ((kAway >> kAxis & 1) != 0) return StepAlong<kAxis, kStep>(None(), seen);
    return Or(seen, StepAlong<kAxis, kStep>(seen, None()));
  }
}

template <Sublattice kSublattice>
PositionMask FindTouched(std::span<const BrickBits> bricks, BrickIndex n,
                         const BrickNeighborhood& neighbors) {
  constexpr Step kStep = kSublattice == Sublattice::kEven ? Step::kDown : Step::kUp;
  const Plane own = LoadPlane(bricks[n]), nothing = None();
  PositionMask touched = 0;
  const auto add = [&](int position, const Plane& seeing)
                       HWY_ATTR { touched |= (IsEmpty(And(own, seeing)) ? 0u : 1u) << position; };
  const auto brick = [&](size_t position)
                         HWY_ATTR { return LoadPlane(bricks[neighbors[position]]); };
  add(0, CellsThatSee<0, kStep>(brick(0)));
  add(1, CellsThatSee<1, kStep>(brick(1)));
  add(2, CellsThatSee<2, kStep>(brick(2)));
  add(3, CellsThatSee<3, kStep>(brick(3)));
  add(4, CellsThatSee<4, kStep>(brick(4)));
  add(5, CellsThatSee<5, kStep>(brick(5)));
  add(6, CellsThatSee<6, kStep>(brick(6)));
  add(7, CellsThatSee<7, kStep>(brick(7)));
  add(8, StepX<Step::kUp>(nothing, brick(8)));
  add(9, StepX<Step::kDown>(nothing, brick(9)));
  add(10, StepY<Step::kUp>(nothing, brick(10)));
  add(11, StepY<Step::kDown>(nothing, brick(11)));
  add(12, StepZ<Step::kUp>(nothing, brick(12)));
  add(13, StepZ<Step::kDown>(nothing, brick(13)));
  return touched;
}

PositionMask FindTouchedBricksTarget(Sublattice sublattice, std::span<const BrickBits> bricks,
                                     BrickIndex n, const BrickNeighborhood& neighbors) {
  return sublattice == Sublattice::kEven ? FindTouched<Sublattice::kEven>(bricks, n, neighbors)
                                         : FindTouched<Sublattice::kOdd>(bricks, n, neighbors);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindNeighborPlanesTarget);
HWY_EXPORT(FindTouchedBricksTarget);

NeighborPlanes FindNeighborPlanes(Sublattice sublattice, const BrickSurroundings& bricks) {
  NeighborPlanes planes;
  HWY_DYNAMIC_DISPATCH(FindNeighborPlanesTarget)(sublattice, bricks, planes);
  return planes;
}
NeighborPlanes NeighborPlanesOf(const Volume& object, BrickIndex brick) {
  const auto bricks = object.padded_bricks();
  BrickSurroundings surroundings = {bricks[brick], {}};
  const BrickNeighborhood& neighbors = object.neighbors()[brick];
  for (size_t n = 0; n < neighbors.size(); ++n) surroundings.around[n] = bricks[neighbors[n]];
  return FindNeighborPlanes(object.keys()[brick].sublattice(), surroundings);
}
PositionMask FindTouchedBricks(Sublattice sublattice, std::span<const BrickBits> bricks,
                               BrickIndex n, const BrickNeighborhood& neighbors) {
  return HWY_DYNAMIC_DISPATCH(FindTouchedBricksTarget)(sublattice, bricks, n, neighbors);
}

}  // namespace bccskel
#endif  // HWY_ONCE
