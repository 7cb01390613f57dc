#include "core/thinning/mark_symmetric.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/thinning/mark_symmetric.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/thinning/link_circuits-inl.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

template <Sublattice kSublattice>
HWY_INLINE void LinkOf(const ObjectView& view, BrickIndex brick, Plane (&link)[14]) {
  AllPlanes<kSublattice>(view.object, view.neighbors[brick], LoadPlane(view.object[brick]), link);
}

HWY_INLINE Plane CandidatesOf(const ObjectView& view, BrickIndex brick) {
  return And(LoadPlane(view.object[brick]), LoadPlane(view.candidates[brick]));
}

template <Sublattice kSublattice>
size_t FindSimpleIn(const ObjectView& view, EndPoints end_points, std::span<BrickIndex> bricks,
                    BrickBits* simple) {
  size_t count = 0;
  for (const BrickIndex brick : bricks) {
    Plane link[14];
    LinkOf<kSublattice>(view, brick, link);
    Plane found = And(CandidatesOf(view, brick), Simple(link));
    if (end_points == EndPoints::kStay) found = And(found, SeveralNeighbors(link));
    StorePlane(found, simple[brick]);
    bricks[count] = brick;
    count += IsEmpty(found) ? 0 : 1;
  }
  return count;
}

template <Sublattice kSublattice>
size_t MarkIsthmusesIn(const ObjectView& view, SkeletonKind kind,
                       std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  size_t count = 0;
  for (const BrickIndex brick : bricks) {
    Plane link[14];
    LinkOf<kSublattice>(view, brick, link);
    const Plane isthmus = kind == SkeletonKind::kSurface ? TwoIsthmus(link) : OneIsthmus(link);
    const Plane marks = And(CandidatesOf(view, brick), isthmus);
    StorePlane(marks, marked[count].marks);
    marked[count].brick = brick;
    count += IsEmpty(marks) ? 0 : 1;
  }
  return count;
}

// For each of a set of neighbors, a plane of the points that have a color higher than it. Colors
// are (x + y + z + pass) mod 4: D6 neighbors are two apart, D8 neighbors one or minus one.
struct HigherColor {
  Plane by_step[4];  // that of the neighbor less that of the point, modulo 4

  HWY_INLINE HigherColor(Sublattice sublattice, int32_t pass) {
    // Cells with an odd sum of indices; a brick starts at an even one.
    BrickBits odd;
    for (size_t k = 0; k < 8; ++k) odd.words[k] = (k & 1) == 0 ? kOddInEvenLayer : ~kOddInEvenLayer;
    const int first = ((sublattice == Sublattice::kOdd ? 3 : 0) + pass) & 3;
    for (int step = 1; step < 4; ++step) {
      // Colors are first and first + 2; a point's is the higher if adding the step wraps around.
      const Plane plane = LoadPlane(odd);
      const bool even_wraps = first + step > 3, odd_wraps = ((first + 2) & 3) + step > 3;
      by_step[step] = None();
      if (even_wraps) by_step[step] = Or(by_step[step], Not(plane));
      if (odd_wraps) by_step[step] = Or(by_step[step], plane);
    }
    by_step[0] = None();
  }
  HWY_INLINE const Plane& Than(int neighbor) const {
    const LatticePoint offset = kDirections14[static_cast<size_t>(neighbor)];
    return by_step[(offset.x + offset.y + offset.z) & 3];
  }

 private:
  static constexpr uint64_t kOddInEvenLayer = 0x5555aaaa5555aaaa;
};

// What subtracting two planes of bits borrows from the next place.
HWY_INLINE Plane Borrow(const Plane& from, const Plane& bits, const Plane& borrowed) {
#if HWY_TARGET <= HWY_AVX3
  return {{BrickLane{
      _mm512_ternarylogic_epi64(from.v[0].raw, bits.v[0].raw, borrowed.v[0].raw, 0x8e)}}};
#else
  return Or(AndNot(from, Or(bits, borrowed)), And(bits, borrowed));
#endif
}

// For each neighbor, the points whose priority is higher than its. Depths of neighbors differ by
// at most nine quarters, so the sign of their difference modulo 32 tells; a point that wins by its
// color needs no more than an equal depth.
template <Sublattice kSublattice>
HWY_INLINE void HigherThanNeighbors(const CliqueView& view, BrickIndex brick,
                                    const HigherColor& color, Plane (&higher)[14]) {
  constexpr size_t kLast = 4;
  Plane borrow[14];
  for (int n = 0; n < 14; ++n) borrow[n] = Not(color.Than(n));
  const BrickNeighborhood& neighbors = view.object.neighbors[brick];
  for (size_t bit = 0; bit <= kLast; ++bit) {
    const Plane own = LoadPlane(view.depth[brick][bit]);
    Plane other[14];
    AllPlanes<kSublattice>(&view.depth[0][bit], neighbors, own, other, kShellPlanes);
    for (int n = 0; n < 14; ++n) {
      if (bit < kLast) {
        borrow[n] = Borrow(own, other[n], borrow[n]);
      } else {
        higher[n] = Not(Xor(own, other[n], borrow[n]));
      }
    }
  }
}

// Points of S in critical cliques of one size with neighbors in `among`.
template <CliqueSize kSize>
HWY_INLINE Plane InCritical(const Plane (&link)[14], const Plane (&among)[14]) {
  if constexpr (kSize == CliqueSize::kPair) {
    Plane critical[14];
    CriticalPairs(link, among, critical);
    Plane any = critical[0];
    for (int n = 1; n < 14; ++n) any = Or(any, critical[n]);
    return any;
  } else if constexpr (kSize == CliqueSize::kTriple) {
    return InCriticalTriple(link, among);
  } else {
    return InTetrahedron(among);
  }
}

// A point is sent back if it is in a critical clique with neighbors that all are lower.
template <Sublattice kSublattice, CliqueSize kSize>
HWY_INLINE Plane SentBack(const CliqueView& view, BrickIndex brick, const HigherColor& color,
                          const Plane& own) {
  Plane link[14], among[14], higher[14];
  AllPlanes<kSublattice>(view.simple, view.object.neighbors[brick], own, among);
  if constexpr (kSize != CliqueSize::kQuadruple) LinkOf<kSublattice>(view.object, brick, link);
  const Plane critical = And(own, InCritical<kSize>(link, among));
  if (IsEmpty(critical)) return critical;
  HigherThanNeighbors<kSublattice>(view, brick, color, higher);
  for (int n = 0; n < 14; ++n) among[n] = And(among[n], higher[n]);
  return And(critical, InCritical<kSize>(link, among));
}

template <Sublattice kSublattice, CliqueSize kSize>
void SendBack(const CliqueView& view, std::span<const BrickIndex> bricks, BrickBits* left,
              Unsettled* unsettled) {
  const HigherColor color(kSublattice, view.pass);
  for (const BrickIndex brick : bricks) {
    const Plane own = LoadPlane(view.simple[brick]);
    const Plane back = SentBack<kSublattice, kSize>(view, brick, color, own);
    StorePlane(AndNot(back, own), left[brick]);
    const auto again = static_cast<Unsettled>(IsEmpty(back) ? 0 : kDirectionsUnsettled);
    unsettled[brick] = static_cast<Unsettled>(unsettled[brick] | again);
  }
}

size_t FindSimpleTarget(const ObjectView& view, Sublattice sublattice, EndPoints end_points,
                        std::span<BrickIndex> bricks, BrickBits* simple) {
  return sublattice == Sublattice::kEven
             ? FindSimpleIn<Sublattice::kEven>(view, end_points, bricks, simple)
             : FindSimpleIn<Sublattice::kOdd>(view, end_points, bricks, simple);
}

size_t MarkIsthmusesTarget(const ObjectView& view, Sublattice sublattice, SkeletonKind kind,
                           std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return sublattice == Sublattice::kEven
             ? MarkIsthmusesIn<Sublattice::kEven>(view, kind, bricks, marked)
             : MarkIsthmusesIn<Sublattice::kOdd>(view, kind, bricks, marked);
}

template <Sublattice kSublattice>
void SendBackOfSize(CliqueSize size, const CliqueView& view, std::span<const BrickIndex> bricks,
                    BrickBits* left, Unsettled* unsettled) {
  switch (size) {
    case CliqueSize::kPair:
      return SendBack<kSublattice, CliqueSize::kPair>(view, bricks, left, unsettled);
    case CliqueSize::kTriple:
      return SendBack<kSublattice, CliqueSize::kTriple>(view, bricks, left, unsettled);
    case CliqueSize::kQuadruple:
      return SendBack<kSublattice, CliqueSize::kQuadruple>(view, bricks, left, unsettled);
  }
}

void SendBackTarget(CliqueSize size, const CliqueView& view, Sublattice sublattice,
                    std::span<const BrickIndex> bricks, BrickBits* left, Unsettled* unsettled) {
  if (sublattice == Sublattice::kEven) {
    SendBackOfSize<Sublattice::kEven>(size, view, bricks, left, unsettled);
  } else {
    SendBackOfSize<Sublattice::kOdd>(size, view, bricks, left, unsettled);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindSimpleTarget);
HWY_EXPORT(MarkIsthmusesTarget);
HWY_EXPORT(SendBackTarget);

size_t FindSimple(const ObjectView& view, Sublattice sublattice, EndPoints end_points,
                  std::span<BrickIndex> bricks, BrickBits* simple) {
  return HWY_DYNAMIC_DISPATCH(FindSimpleTarget)(view, sublattice, end_points, bricks, simple);
}
size_t MarkIsthmuses(const ObjectView& view, Sublattice sublattice, SkeletonKind kind,
                     std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return HWY_DYNAMIC_DISPATCH(MarkIsthmusesTarget)(view, sublattice, kind, bricks, marked);
}
void SendBackFromCritical(CliqueSize size, const CliqueView& view, Sublattice sublattice,
                          std::span<const BrickIndex> bricks, BrickBits* left,
                          Unsettled* unsettled) {
  HWY_DYNAMIC_DISPATCH(SendBackTarget)(size, view, sublattice, bricks, left, unsettled);
}

}  // namespace bccskel
#endif  // HWY_ONCE
