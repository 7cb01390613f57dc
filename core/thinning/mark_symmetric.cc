#include "core/thinning/mark_symmetric.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/thinning/mark_symmetric.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/thinning/add_marks-inl.h"
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

HWY_INLINE Plane AnyOf(const Plane (&planes)[14]) {
  Plane any = planes[0];
  for (int n = 1; n < 14; ++n) any = Or(any, planes[n]);
  return any;
}

HWY_INLINE Plane CandidatesOf(const ObjectView& view, BrickIndex brick) {
  return And(LoadPlane(view.object[brick]), LoadPlane(view.candidates[brick]));
}

template <Sublattice kSublattice>
size_t FindSimpleIn(const ObjectView& view, EndPoints end_points, std::span<BrickIndex> bricks,
                    BrickBits* simple, std::vector<MarkedBrick>& ends) {
  size_t count = 0;
  for (size_t at = 0; at < bricks.size(); ++at) {
    if (view.is_far) PrefetchAhead(view, kSublattice, bricks, at, simple);
    const BrickIndex brick = bricks[at];
    Plane link[14];
    LinkOf<kSublattice>(view, brick, link);
    const Plane candidates = CandidatesOf(view, brick);
    Plane found = And(candidates, Simple(link));
    if (end_points == EndPoints::kStay) {
      const Plane several = SeveralNeighbors(link);
      found = And(found, several);
      AddIfAny(AndNot(several, And(candidates, AnyOf(link))), brick, ends);
    }
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

// For each of a set of neighbors, a plane of the points whose color is higher than that neighbor's.
// Colors are (x + y + z + pass) mod 4: those of D6 neighbors differ by two, those of D8 neighbors
// by one or minus one.
struct HigherColor {
  Plane by_step[4];  // by color of the neighbor minus that of the point, modulo 4

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

// The borrow of subtracting two bit planes.
HWY_INLINE Plane Borrow(const Plane& from, const Plane& bits, const Plane& borrowed) {
#if HWY_TARGET <= HWY_AVX3
  return {{BrickLane{
      _mm512_ternarylogic_epi64(from.v[0].raw, bits.v[0].raw, borrowed.v[0].raw, 0x8e)}}};
#else
  return Or(AndNot(from, Or(bits, borrowed)), And(bits, borrowed));
#endif
}

// For each neighbor, the points with a higher priority. Depths of neighbors differ by at most nine
// quarters, so the sign of their difference modulo 32 decides; a point with the higher color also
// wins at equal depth.
template <Sublattice kSublattice>
HWY_INLINE void HigherThanNeighbors(const RuleBView& view, BrickIndex brick,
                                    const HigherColor& color, Plane (&higher)[14]) {
  constexpr size_t kLast = kDepthPlanes - 1;
  Plane borrow[14];
  for (int n = 0; n < 14; ++n) borrow[n] = Not(color.Than(n));
  const BrickNeighborhood& neighbors = view.object.neighbors[brick];
  for (size_t bit = 0; bit <= kLast; ++bit) {
    const Plane own = LoadPlane(view.depth[brick][bit]);
    Plane other[14];
    AllPlanes<kSublattice>(&view.depth[0][bit], neighbors, own, other, kDepthPlanes);
    for (int n = 0; n < 14; ++n) {
      if (bit < kLast) {
        borrow[n] = Borrow(own, other[n], borrow[n]);
      } else {
        higher[n] = Not(Xor(own, other[n], borrow[n]));
      }
    }
  }
}

HWY_INLINE void AndEach(const Plane (&with)[14], Plane (&planes)[14]) {
  for (int n = 0; n < 14; ++n) planes[n] = And(planes[n], with[n]);
}

// The next pass revisits bricks where points were unmarked.
HWY_INLINE void MarkDirtyIf(const Plane& sent_back, DirtyMask& brick) {
  brick = static_cast<DirtyMask>(brick | (IsEmpty(sent_back) ? 0 : kDirectionsDirty));
}

// Points of S that have the highest priority in a critical pair.
template <Sublattice kSublattice>
HWY_INLINE Plane HighestInPairs(const RuleBView& view, BrickIndex brick, const HigherColor& color,
                                const Plane& own, Plane (&critical)[14]) {
  Plane higher[14];
  HigherThanNeighbors<kSublattice>(view, brick, color, higher);
  AndEach(higher, critical);
  return And(own, AnyOf(critical));
}

template <Sublattice kSublattice>
size_t PairsIn(const RuleBView& view, std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  const HigherColor color(kSublattice, view.pass);
  size_t count = 0;
  for (size_t at = 0; at < bricks.size(); ++at) {
    if (view.object.is_far) PrefetchAhead(view.object, kSublattice, bricks, at, view.simple);
    const BrickIndex brick = bricks[at];
    const Plane own = LoadPlane(view.simple[brick]);
    Plane link[14], among[14], critical[14];
    LinkOf<kSublattice>(view.object, brick, link);
    AllPlanes<kSublattice>(view.simple, view.object.neighbors[brick], own, among);
    CriticalPairs(link, among, critical);
    Plane left = own;
    if (!IsEmpty(And(own, AnyOf(critical)))) {
      const Plane back = HighestInPairs<kSublattice>(view, brick, color, own, critical);
      MarkDirtyIf(back, view.dirty[brick]);
      left = AndNot(back, own);
    }
    StorePlane(left, view.after_pairs[brick]);
    StorePlane(left, view.after_triples[brick]);
    const Plane larger = Or(InCriticalTriple(link, among), InTetrahedron(among));
    const bool is_final = IsEmpty(And(left, larger));
    view.larger_cliques[brick] = is_final ? 0 : 1;
    StorePlane(left, marked[count].marks);
    marked[count].brick = brick;
    count += is_final && !IsEmpty(left) ? 1 : 0;
  }
  return count;
}

// Points of S that have the highest priority in a critical triple or, with the other test, in a
// quadruple.
template <Sublattice kSublattice, typename InCritical>
HWY_INLINE Plane HighestInLarger(const RuleBView& view, BrickIndex brick, const HigherColor& color,
                                 const BrickBits* simple, const Plane& own,
                                 InCritical in_critical) {
  Plane link[14], among[14], higher[14];
  LinkOf<kSublattice>(view.object, brick, link);
  AllPlanes<kSublattice>(simple, view.object.neighbors[brick], own, among);
  const Plane critical = And(own, in_critical(link, among));
  if (IsEmpty(critical)) return critical;
  HigherThanNeighbors<kSublattice>(view, brick, color, higher);
  AndEach(higher, among);
  return And(critical, in_critical(link, among));
}

template <Sublattice kSublattice>
void TriplesIn(const RuleBView& view, std::span<const BrickIndex> bricks) {
  const HigherColor color(kSublattice, view.pass);
  for (const BrickIndex brick : bricks) {
    if (view.larger_cliques[brick] == 0) continue;
    const Plane own = LoadPlane(view.after_pairs[brick]);
    const Plane back = HighestInLarger<kSublattice>(
        view, brick, color, view.after_pairs, own,
        [](const auto& link, const auto& among) HWY_ATTR { return InCriticalTriple(link, among); });
    MarkDirtyIf(back, view.dirty[brick]);
    StorePlane(AndNot(back, own), view.after_triples[brick]);
  }
}

template <Sublattice kSublattice>
size_t QuadruplesIn(const RuleBView& view, std::span<const BrickIndex> bricks,
                    MarkedBrick* marked) {
  const HigherColor color(kSublattice, view.pass);
  size_t count = 0;
  for (const BrickIndex brick : bricks) {
    if (view.larger_cliques[brick] == 0) continue;
    const Plane own = LoadPlane(view.after_triples[brick]);
    const Plane back = HighestInLarger<kSublattice>(view, brick, color, view.after_triples, own,
                                                    [](const auto&, const auto& among)
                                                        HWY_ATTR { return InTetrahedron(among); });
    MarkDirtyIf(back, view.dirty[brick]);
    Append(AndNot(back, own), brick, marked, count);
  }
  return count;
}

size_t FindSimpleTarget(const ObjectView& view, Sublattice sublattice, EndPoints end_points,
                        std::span<BrickIndex> bricks, BrickBits* simple,
                        std::vector<MarkedBrick>& ends) {
  return sublattice == Sublattice::kEven
             ? FindSimpleIn<Sublattice::kEven>(view, end_points, bricks, simple, ends)
             : FindSimpleIn<Sublattice::kOdd>(view, end_points, bricks, simple, ends);
}

size_t MarkIsthmusesTarget(const ObjectView& view, Sublattice sublattice, SkeletonKind kind,
                           std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return sublattice == Sublattice::kEven
             ? MarkIsthmusesIn<Sublattice::kEven>(view, kind, bricks, marked)
             : MarkIsthmusesIn<Sublattice::kOdd>(view, kind, bricks, marked);
}

size_t PairsTarget(const RuleBView& view, Sublattice sublattice, std::span<const BrickIndex> bricks,
                   MarkedBrick* marked) {
  return sublattice == Sublattice::kEven ? PairsIn<Sublattice::kEven>(view, bricks, marked)
                                         : PairsIn<Sublattice::kOdd>(view, bricks, marked);
}
void TriplesTarget(const RuleBView& view, Sublattice sublattice,
                   std::span<const BrickIndex> bricks) {
  sublattice == Sublattice::kEven ? TriplesIn<Sublattice::kEven>(view, bricks)
                                  : TriplesIn<Sublattice::kOdd>(view, bricks);
}
size_t QuadruplesTarget(const RuleBView& view, Sublattice sublattice,
                        std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return sublattice == Sublattice::kEven ? QuadruplesIn<Sublattice::kEven>(view, bricks, marked)
                                         : QuadruplesIn<Sublattice::kOdd>(view, bricks, marked);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindSimpleTarget);
HWY_EXPORT(MarkIsthmusesTarget);
HWY_EXPORT(PairsTarget);
HWY_EXPORT(TriplesTarget);
HWY_EXPORT(QuadruplesTarget);

size_t FindSimple(const ObjectView& view, Sublattice sublattice, EndPoints end_points,
                  std::span<BrickIndex> bricks, BrickBits* simple, std::vector<MarkedBrick>& ends) {
  return HWY_DYNAMIC_DISPATCH(FindSimpleTarget)(view, sublattice, end_points, bricks, simple, ends);
}
size_t MarkIsthmuses(const ObjectView& view, Sublattice sublattice, SkeletonKind kind,
                     std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return HWY_DYNAMIC_DISPATCH(MarkIsthmusesTarget)(view, sublattice, kind, bricks, marked);
}
size_t SendBackFromPairs(const RuleBView& view, Sublattice sublattice,
                         std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return HWY_DYNAMIC_DISPATCH(PairsTarget)(view, sublattice, bricks, marked);
}
void SendBackFromTriples(const RuleBView& view, Sublattice sublattice,
                         std::span<const BrickIndex> bricks) {
  HWY_DYNAMIC_DISPATCH(TriplesTarget)(view, sublattice, bricks);
}
size_t SendBackFromQuadruples(const RuleBView& view, Sublattice sublattice,
                              std::span<const BrickIndex> bricks, MarkedBrick* marked) {
  return HWY_DYNAMIC_DISPATCH(QuadruplesTarget)(view, sublattice, bricks, marked);
}

}  // namespace bccskel
#endif  // HWY_ONCE
