// Does: counts points - edges + triangles - tetrahedra of the clique complex, 512 points at a time.
//
// Why it is right: put the points in one by one in the order of f(p) = x + y + z. No two neighbors
// have equal f. Point p then adds 1 - chi(L), where L is the part of its link already there: the
// object points among its seven neighbors with smaller f (all cliques that p completes, counted
// where they are completed, so each clique is counted once). The seven form a wheel:
//
//          (-2,0,0)---(-1,-1,1)
//            /     \ /     \                the hub h = (-1,-1,-1) is a neighbor of all six of the
//     (-1,1,-1)-----h-----(0,-2,0)          rim, the rim is a closed hexagon
//            \     / \     /
//          (0,0,-2)---(1,-1,-1)
//
// With the hub in the object L is a cone over it and chi(L) = 1: p adds nothing. Without the hub L
// is a part of the hexagon, and its points less its edges are as many as its arcs (none for the
// full rim). So
//     chi = sum over points p with p + h in the background of (1 - arcs of the rim in the object),
// and only points at one side of the object's border count.
//
// Cost: seven neighbor planes per brick, about 25 logic operations and 3 bit counts per register;
//       a brick whose points all have their hub costs one plane.
#include <array>

#include "core/certificate/brick_sum.h"
#include "core/certificate/certificate.h"
#include "core/lattice/directions.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/certificate/euler_characteristic.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"
// clang-format on

#ifndef BCCSKEL_CORE_CERTIFICATE_EULER_CHARACTERISTIC_WHEEL
#define BCCSKEL_CORE_CERTIFICATE_EULER_CHARACTERISTIC_WHEEL
namespace bccskel {
namespace {

constexpr LatticePoint kHub = {-1, -1, -1};
constexpr std::array<LatticePoint, 6> kRim = {
    {{-2, 0, 0}, {-1, -1, 1}, {0, -2, 0}, {1, -1, -1}, {0, 0, -2}, {-1, 1, -1}}};

constexpr bool IsWheel() {
  for (size_t n = 0; n < 6; ++n) {
    if (!FindDirection(kRim[n]) || !FindDirection(kRim[n] - kHub)) return false;
    for (size_t m = 0; m < n; ++m) {
      const bool next = n - m == 1 || n - m == 5;
      if (FindDirection(kRim[n] - kRim[m]).has_value() != next) return false;
    }
  }
  return true;
}
static_assert(IsWheel());

constexpr int BitOf(LatticePoint offset) { return FindDirection(offset)->bit(); }

}  // namespace
}  // namespace bccskel
#endif  // wheel

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

using Counts = hn::Vec<BrickTag>;  // 64-bit numbers, modulo 2^64

HWY_INLINE Counts AddTerms(const Plane& counted, const Plane (&rim)[6], Counts sum) {
  // An arc ends where a rim point is in the object and the next one is not. No two arcs end side by
  // side, so of three ends in a row only the outer two can come together; and there are at most
  // three in all, so the carries of the three sums exclude each other.
  const Plane a = AndNot(rim[1], rim[0]), b = AndNot(rim[2], rim[1]), c = AndNot(rim[3], rim[2]);
  const Plane d = AndNot(rim[4], rim[3]), e = AndNot(rim[5], rim[4]), f = AndNot(rim[0], rim[5]);
  const Plane abc = Xor(Xor(a, b), c), def = Xor(Xor(d, e), f);
  const Plane carries = Or(And(a, c), And(d, f));
  const Plane ones = And(counted, Xor(abc, def));
  const Plane twos = And(counted, Or(carries, And(abc, def)));
  for (size_t n = 0; n < kVectors; ++n) {
    const Counts two = hn::PopulationCount(twos.v[n]);
    sum = hn::Add(sum, hn::PopulationCount(counted.v[n]));
    sum = hn::Sub(sum, hn::Add(hn::PopulationCount(ones.v[n]), hn::Add(two, two)));
  }
  return sum;
}

template <Sublattice kSublattice>
HWY_INLINE Counts AddBrick(const BrickBits* bricks, const BrickNeighborhood& neighbors,
                           const Plane& own, Counts sum) {
  constexpr Step kStep = kSublattice == Sublattice::kEven ? Step::kDown : Step::kUp;
  const PlaneReader<kStep> read{bricks, neighbors};
  const Plane counted = AndNot(read.template Diagonal<AxesOf(kSublattice, BitOf(kHub))>(), own);
  if (IsEmpty(counted)) return sum;
  Plane planes[kNeighborCount];
  AllPlanes<kSublattice>(bricks, neighbors, own, planes);
  const Plane rim[6] = {planes[BitOf(kRim[0])], planes[BitOf(kRim[1])], planes[BitOf(kRim[2])],
                        planes[BitOf(kRim[3])], planes[BitOf(kRim[4])], planes[BitOf(kRim[5])]};
  return AddTerms(counted, rim, sum);
}

int64_t SumBricksTarget(const Volume& object, exec::Share share) {
  const BrickBits* bricks = object.padded_bricks().data();
  const BrickNeighborhood* neighbors = object.neighbors().data();
  Counts sum = hn::Zero(BrickTag());
  for (size_t n = share.begin; n < share.end; ++n) {
    const Plane own = LoadPlane(bricks[n]);
    sum = object.keys()[n].sublattice() == Sublattice::kEven
              ? AddBrick<Sublattice::kEven>(bricks, neighbors[n], own, sum)
              : AddBrick<Sublattice::kOdd>(bricks, neighbors[n], own, sum);
  }
  return static_cast<int64_t>(hn::GetLane(hn::SumOfLanes(BrickTag(), sum)));
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(SumBricksTarget);

int64_t CountEulerCharacteristic(const Volume& object, const exec::Context& context) {
  return SumOverBricks(context, object.brick_count(), [&](int, exec::Share batch) {
    return HWY_DYNAMIC_DISPATCH(SumBricksTarget)(object, batch);
  });
}

}  // namespace bccskel
#endif  // HWY_ONCE
