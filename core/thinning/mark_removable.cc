#include "core/thinning/mark_removable.h"

#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/thinning/mark_removable.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/thinning/add_marks-inl.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

constexpr Step StepOf(Sublattice sublattice) {
  return sublattice == Sublattice::kEven ? Step::kDown : Step::kUp;
}

// At most one of four planes.
HWY_INLINE Plane AtMostOne(const Plane& a, const Plane& b, const Plane& c, const Plane& d,
                           const Plane& among) {
  const Plane two = Or(And(a, b), And(c, d));
  return AndNot(Or(two, And(Or(a, b), Or(c, d))), among);
}

// Conditions 1 to 4. `kAxes` are the axes of d. In most bricks no candidate has at most one object
// neighbor along y and z, so that is tested before searching for end points.
template <Sublattice kSublattice, int kAxes>
HWY_INLINE Plane Removable(const ObjectView& view, BrickIndex brick,
                           std::vector<MarkedBrick>& ends) {
  constexpr Step kStep = StepOf(kSublattice);
  const PlaneReader<kStep> read{view.object, view.neighbors[brick]};
  const Plane own = LoadPlane(view.object[brick]);
  Plane diagonal[8];
  read.AllDiagonals(diagonal);
  constexpr int kBack = 7 ^ kAxes;
  const Plane candidates = And(own, LoadPlane(view.candidates[brick]));
  Plane removable = AndNot(diagonal[kBack], And(candidates, diagonal[kAxes]));
  // On each axis, with e the D6 step to d's side: "d's sign on this axis only" => e, and -e =>
  // "d's sign on the other two". Moving along an axis lies on d's side for an odd brick iff the
  // direction is positive there; in terms of moved axes both sublattices read alike.
  constexpr Step kOther = kStep == Step::kDown ? Step::kUp : Step::kDown;
  Plane right = diagonal[kAxes ^ 1];
  Plane towards[3], aways[3];  // by axis
  const auto imply = [&]<int kAxis>(std::integral_constant<int, kAxis>) HWY_ATTR {
    constexpr bool kMoved = ((kAxes >> kAxis) & 1) != 0;
    const Plane toward = read.template Axial < kAxis, kMoved ? kStep : kOther > (own);
    const Plane away = read.template Axial < kAxis, kMoved ? kOther : kStep > (own);
    const Plane& alone = diagonal[kBack ^ (1 << kAxis)];
    const Plane& opposite = diagonal[kAxes ^ (1 << kAxis)];
    removable = AndNot(AndNot(toward, alone), removable);
    removable = AndNot(AndNot(opposite, away), removable);
    right = Or(right, Or(toward, opposite));
    towards[kAxis] = toward;
    aways[kAxis] = away;
  };
  imply(std::integral_constant<int, 0>());
  imply(std::integral_constant<int, 1>());
  imply(std::integral_constant<int, 2>());
  const Plane thin = AtMostOne(towards[1], aways[1], towards[2], aways[2], candidates);
  if (!IsEmpty(thin)) {
    Plane some = Or(Or(towards[1], aways[1]), Or(towards[2], aways[2]));
    Plane several = Or(And(towards[0], aways[0]), And(some, Or(towards[0], aways[0])));
    some = Or(some, Or(towards[0], aways[0]));
    for (int n = 0; n < 8; ++n) {
      several = Or(several, And(some, diagonal[n]));
      some = Or(some, diagonal[n]);
    }
    AddIfAny(AndNot(several, And(some, thin)), brick, ends);
  }
  return And(removable, right);
}

HWY_INLINE Plane Thin(const ObjectView& view, BrickIndex brick) {
  const PlaneReader<Step::kUp> read{view.object, view.neighbors[brick]};  // D6 planes only
  const Plane own = LoadPlane(view.object[brick]);
  return AtMostOne(read.template Axial<1, Step::kUp>(own), read.template Axial<1, Step::kDown>(own),
                   read.template Axial<2, Step::kUp>(own), read.template Axial<2, Step::kDown>(own),
                   And(own, LoadPlane(view.candidates[brick])));
}

HWY_INLINE Plane EndPoints(const ObjectView& view, Sublattice sublattice, BrickIndex brick) {
  const Plane own = LoadPlane(view.object[brick]);
  Plane planes[14];
  AllPlanes(sublattice, view.object, view.neighbors[brick], own, planes);
  Plane some = planes[0];
  Plane several = And(planes[0], planes[1]);
  some = Or(some, planes[1]);
  for (int n = 2; n < 14; ++n) {
    several = Or(several, And(some, planes[n]));
    some = Or(some, planes[n]);
  }
  return AndNot(several, And(some, And(own, LoadPlane(view.candidates[brick]))));
}

HWY_INLINE Plane PossiblySimple(const ObjectView& view, Sublattice sublattice, BrickIndex brick) {
  const Plane own = LoadPlane(view.object[brick]);
  Plane p[14];
  AllPlanes(sublattice, view.object, view.neighbors[brick], own, p);
  // A D8 neighbor is adjacent to the D8 neighbors that differ in one sign and to the D6 neighbors
  // on its three sides; D6 neighbors are not adjacent to each other.
  Plane adjacent = And(p[0], Or(p[1], Or(p[2], p[4])));
  adjacent = Or(adjacent, And(p[3], Or(p[1], Or(p[2], p[7]))));
  adjacent = Or(adjacent, And(p[5], Or(p[1], Or(p[4], p[7]))));
  adjacent = Or(adjacent, And(p[6], Or(p[2], Or(p[4], p[7]))));
  adjacent = Or(adjacent, And(p[8], Or(Or(p[1], p[3]), Or(p[5], p[7]))));
  adjacent = Or(adjacent, And(p[9], Or(Or(p[0], p[2]), Or(p[4], p[6]))));
  adjacent = Or(adjacent, And(p[10], Or(Or(p[2], p[3]), Or(p[6], p[7]))));
  adjacent = Or(adjacent, And(p[11], Or(Or(p[0], p[1]), Or(p[4], p[5]))));
  adjacent = Or(adjacent, And(p[12], Or(Or(p[4], p[5]), Or(p[6], p[7]))));
  adjacent = Or(adjacent, And(p[13], Or(Or(p[0], p[1]), Or(p[2], p[3]))));
  return And(adjacent, And(own, LoadPlane(view.candidates[brick])));
}

using MarkFunction = size_t (*)(const ObjectView&, std::span<const BrickIndex>, MarkedBrick*,
                                std::vector<MarkedBrick>&);

template <Sublattice kSublattice, int kDirection>
size_t MarkDirection(const ObjectView& view, std::span<const BrickIndex> bricks,
                     MarkedBrick* marked, std::vector<MarkedBrick>& ends) {
  size_t count = 0;
  for (size_t at = 0; at < bricks.size(); ++at) {
    if (view.is_far) PrefetchAhead(view, kSublattice, bricks, at);
    const BrickIndex brick = bricks[at];
    Append(Removable<kSublattice, AxesOf(kSublattice, kDirection)>(view, brick, ends), brick,
           marked, count);
  }
  return count;
}

template <Sublattice kSublattice, int... kDirections>
constexpr std::array<MarkFunction, 8> MarkTable(std::integer_sequence<int, kDirections...>) {
  return {MarkDirection<kSublattice, kDirections>...};
}

size_t MarkRemovableTarget(const ObjectView& view, Sublattice sublattice, int d,
                           std::span<const BrickIndex> bricks, MarkedBrick* marked,
                           std::vector<MarkedBrick>& ends) {
  static constexpr std::array<MarkFunction, 8> kTables[2] = {
      MarkTable<Sublattice::kEven>(std::make_integer_sequence<int, 8>()),
      MarkTable<Sublattice::kOdd>(std::make_integer_sequence<int, 8>())};
  return kTables[static_cast<size_t>(sublattice)][static_cast<size_t>(d)](view, bricks, marked,
                                                                          ends);
}
void MarkEndPointsTarget(const ObjectView& view, Sublattice sublattice,
                         std::span<const BrickIndex> bricks, std::vector<MarkedBrick>& ends) {
  for (const BrickIndex brick : bricks) {
    if (IsEmpty(Thin(view, brick))) continue;
    AddIfAny(EndPoints(view, sublattice, brick), brick, ends);
  }
}
size_t MarkPossiblySimpleTarget(const ObjectView& view, Sublattice sublattice,
                                std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  size_t count = 0;
  for (const BrickIndex brick : bricks) {
    Append(PossiblySimple(view, sublattice, brick), brick, marked, count);
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(MarkRemovableTarget);
HWY_EXPORT(MarkEndPointsTarget);
HWY_EXPORT(MarkPossiblySimpleTarget);

size_t MarkRemovable(const ObjectView& view, Sublattice sublattice, DiagonalDirection d,
                     std::span<const BrickIndex> bricks, MarkedBrick* marked,
                     std::vector<MarkedBrick>& ends) {
  return HWY_DYNAMIC_DISPATCH(MarkRemovableTarget)(view, sublattice, d.bit(), bricks, marked, ends);
}
void MarkEndPoints(const ObjectView& view, Sublattice sublattice,
                   std::span<const BrickIndex> bricks, std::vector<MarkedBrick>& ends) {
  HWY_DYNAMIC_DISPATCH(MarkEndPointsTarget)(view, sublattice, bricks, ends);
}
size_t MarkPossiblySimple(const ObjectView& view, Sublattice sublattice,
                          std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return HWY_DYNAMIC_DISPATCH(MarkPossiblySimpleTarget)(view, sublattice, bricks, marked);
}

}  // namespace bccskel
#endif  // HWY_ONCE
