#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "core/topology/neighborhood.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_point_set.h"

// The proof that a pass is safe: points removed together from one snapshot keep the topology iff
// every clique of up to four mutually adjacent removed points has a contractible link in the
// object. Cliques are enumerated with all neighborhoods in which each member may go.

namespace bccskel {
namespace {

constexpr LatticePoint kD = {1, 1, 1};
constexpr DiagonalDirection kDirection(7);

using Rule = std::function<bool(NeighborMask)>;

// One point of a clique with its neighborhood.
struct Member {
  LatticePoint point;
  NeighborMask mask;

  bool Sees(LatticePoint q) const { return (mask & FindDirection(q - point)->mask()) != 0; }
};
using Clique = std::vector<Member>;

bool IsNeighbor(LatticePoint p, LatticePoint q) { return FindDirection(q - p).has_value(); }

// The part of each mask that a neighbor in direction n sees too, as bits of that neighbor.
std::vector<NeighborMask> MasksSeenFrom(Direction n) {
  std::vector<NeighborMask> seen(size_t{1} << kNeighborCount);
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const auto moved = FindDirection(Direction(bit).offset() - n.offset());
    if (!moved) continue;
    for (size_t mask = 0; mask < seen.size(); ++mask) {
      if ((mask >> bit & 1) != 0)
        seen[mask] = static_cast<NeighborMask>(seen[mask] | moved->mask());
    }
  }
  return seen;
}

NeighborMask SeenFrom(Direction n, NeighborMask mask) {
  static const std::vector<std::vector<NeighborMask>> seen = [] {
    std::vector<std::vector<NeighborMask>> all;
    for (int bit = 0; bit < kNeighborCount; ++bit) all.push_back(MasksSeenFrom(Direction(bit)));
    return all;
  }();
  return seen[static_cast<size_t>(n.bit())][mask];
}

// Two members that are object points to each other and agree on the neighbors that they share.
struct Agreement {
  Direction to_other;    // from the earlier member to the added one
  NeighborMask seen;     // what the earlier one says of the shared neighbors
  NeighborMask earlier;  // its mask

  bool Holds(NeighborMask added) const {
    return (earlier & to_other.mask()) != 0 && (added & to_other.Opposite().mask()) != 0 &&
           (added & NeighborsAmongN14(to_other.Opposite())) == seen;
  }
};

std::vector<Agreement> AgreementsWith(const std::vector<Member>& clique, LatticePoint q) {
  std::vector<Agreement> agreements;
  for (const Member& member : clique) {
    const Direction to_other = *FindDirection(q - member.point);
    agreements.push_back({to_other, SeenFrom(to_other, member.mask), member.mask});
  }
  return agreements;
}

std::vector<NeighborMask> MasksThatMeet(const Rule& rule) {
  std::vector<NeighborMask> masks;
  for (int n = 0; n < 1 << kNeighborCount; ++n) {
    if (rule(static_cast<NeighborMask>(n))) masks.push_back(static_cast<NeighborMask>(n));
  }
  return masks;
}

// All ways to add one more member, greater than the last one, to the cliques: with `size` 1, 2, 3,
// 4 every clique up to translation appears once for each configuration of its neighborhood.
std::vector<Clique> Extended(const std::vector<Clique>& cliques,
                             const std::vector<NeighborMask>& masks) {
  std::vector<Clique> larger;
  for (const Clique& clique : cliques) {
    for (LatticePoint offset : kDirections14) {
      const LatticePoint q = clique.front().point + offset;
      const auto joins = [&](const Member& m) { return IsNeighbor(m.point, q) && m.point < q; };
      if (!std::ranges::all_of(clique, joins)) continue;
      const std::vector<Agreement> agreements = AgreementsWith(clique, q);
      for (NeighborMask mask : masks) {
        const auto holds = [mask](const Agreement& agreement) { return agreement.Holds(mask); };
        if (!std::ranges::all_of(agreements, holds)) continue;
        larger.push_back(clique);
        larger.back().push_back({q, mask});
      }
    }
  }
  return larger;
}

std::vector<Clique> CliquesOf(int size, const std::vector<NeighborMask>& masks) {
  std::vector<Clique> cliques;
  for (NeighborMask mask : masks) cliques.push_back({{LatticePoint{}, mask}});
  for (int n = 1; n < size; ++n) cliques = Extended(cliques, masks);
  return cliques;
}

// The object points adjacent to all members: for a pair a cycle of four (D6) or six (D8) points
// with some set, for a triple two points.
bool HasContractibleLink(const Clique& clique) {
  unsigned common = 0, object = 0;
  for (LatticePoint offset : kDirections14) {
    const LatticePoint q = clique.front().point + offset;
    const auto adjacent = [&](const Member& m) { return IsNeighbor(m.point, q); };
    if (!std::ranges::all_of(clique, adjacent)) continue;
    common |= FindDirection(offset)->mask();
    if (clique.front().Sees(q)) object |= FindDirection(offset)->mask();
  }
  // A proper part of a cycle is contractible iff it is one arc; of two points, iff it is one point.
  return object != 0 && object != common && ComponentsIn(static_cast<NeighborMask>(object)) == 1;
}

// Each member is simple at its turn in every order of removal.
bool CanGoInAnyOrder(const Clique& clique) {
  for (unsigned gone = 0; gone < 1u << clique.size(); ++gone) {
    for (size_t n = 0; n < clique.size(); ++n) {
      if ((gone >> n & 1) != 0) continue;
      NeighborMask mask = clique[n].mask;
      for (size_t m = 0; m < clique.size(); ++m) {
        if ((gone >> m & 1) == 0) continue;
        const Direction removed = *FindDirection(clique[m].point - clique[n].point);
        mask = static_cast<NeighborMask>(mask & ~removed.mask());
      }
      if (!IsSimple(mask)) return false;
    }
  }
  return true;
}

int64_t CountUnsafe(const std::vector<Clique>& cliques) {
  return std::ranges::count_if(cliques, [](const Clique& c) { return !HasContractibleLink(c); });
}

bool Faithful(NeighborMask mask) { return test::ReferenceIsRemovable(mask, kDirection); }

bool BorderSimpleNonEndWithSequel(NeighborMask mask) {
  return test::ReferenceIsBorderPoint(mask, kDirection) && IsSimpleNonEnd(mask) &&
         test::ReferenceCondition4(mask, kDirection);
}

// Conditions 1, 2 and 4, and one implication for each of the given neighbors: if it is an object
// point, so is the point next to it along d.
Rule WithImplications(std::vector<int> bits) {
  return [bits](NeighborMask mask) {
    return BorderSimpleNonEndWithSequel(mask) && std::ranges::all_of(bits, [mask](int bit) {
             const Direction along = *FindDirection(Direction(bit).offset() + kD);
             return (mask >> bit & 1) == 0 || (mask & along.mask()) != 0;
           });
  };
}

TEST(ParallelRemoval, SixImplicationsAreCondition3) {
  EXPECT_EQ(MasksThatMeet(WithImplications({1, 2, 4, 9, 11, 13})), MasksThatMeet(Faithful));
}

TEST(ParallelRemoval, All54675PairsAreSafe) {
  const auto pairs = CliquesOf(2, MasksThatMeet(Faithful));
  EXPECT_EQ(pairs.size(), 54675u);
  EXPECT_EQ(CountUnsafe(pairs), 0);
  EXPECT_TRUE(std::ranges::all_of(pairs, CanGoInAnyOrder));
}

TEST(ParallelRemoval, All157464TriplesAreSafe) {
  const auto triples = CliquesOf(3, MasksThatMeet(Faithful));
  EXPECT_EQ(triples.size(), 157464u);
  EXPECT_EQ(CountUnsafe(triples), 0);
  EXPECT_TRUE(std::ranges::all_of(triples, CanGoInAnyOrder));
}

// The reasons behind the counts, as the proof words them.
TEST(ParallelRemoval, CommonNeighborsOfATripleAreASequelPointInAndABorderSideOut) {
  for (const Clique& triple : CliquesOf(3, MasksThatMeet(Faithful))) {
    const auto is_common = [&](LatticePoint q) {
      return std::ranges::all_of(triple, [&](const Member& m) { return IsNeighbor(m.point, q); });
    };
    int inside = 0, outside = 0;
    for (const Member& m : triple) {
      inside += is_common(m.point + kD) && m.Sees(m.point + kD);
      outside += is_common(m.point - kD) && !m.Sees(m.point - kD);
    }
    ASSERT_GE(inside, 1);
    ASSERT_GE(outside, 1);
  }
}

TEST(ParallelRemoval, NoFourMutuallyAdjacentPointsGoTogether) {
  EXPECT_TRUE(CliquesOf(4, MasksThatMeet(Faithful)).empty());
}

TEST(ParallelRemoval, OneRingInsteadOfAllThreeGives10095UnsafePairs) {
  const auto some_ring = [](NeighborMask mask) {
    return BorderSimpleNonEndWithSequel(mask) &&
           std::ranges::any_of(kDirections14, [mask](LatticePoint other) {
             return !FindDirection(other)->is_diagonal() &&
                    ComponentsIn(mask & test::ReferenceCheckingRing(other, kD)) == 1;
           });
  };
  EXPECT_EQ(CountUnsafe(CliquesOf(2, MasksThatMeet(some_ring))), 10095);
}

TEST(ParallelRemoval, TheThreeAxialImplicationsAloneAreSafe) {
  const auto masks = MasksThatMeet(WithImplications({9, 11, 13}));
  EXPECT_EQ(masks.size(), 1106u);
  for (int size : {2, 3}) {
    const auto cliques = CliquesOf(size, masks);
    EXPECT_EQ(CountUnsafe(cliques), 0) << size;
    EXPECT_TRUE(std::ranges::all_of(cliques, CanGoInAnyOrder)) << size;
  }
  EXPECT_TRUE(CliquesOf(4, masks).empty());
}

TEST(ParallelRemoval, FewerImplicationsAreUnsafe) {
  const std::vector<std::vector<int>> pairs_of_arcs = {{9, 11}, {9, 13}, {11, 13}};
  for (const std::vector<int>& arcs : pairs_of_arcs) {
    EXPECT_GT(CountUnsafe(CliquesOf(2, MasksThatMeet(WithImplications(arcs)))), 0);
  }
}

// An object whose two first points meet the rule and whose components change when both go.
void ExpectSplits(const std::vector<LatticePoint>& points, const Rule& rule) {
  test::ReferencePointSet object(points);
  EXPECT_EQ(test::ReferenceBetti(object).components, 1);
  const NeighborMask first = object.NeighborsOf(points[0]);
  const NeighborMask second = object.NeighborsOf(points[1]);
  EXPECT_TRUE(rule(first) && rule(second));
  EXPECT_FALSE(Faithful(first) && Faithful(second));
  object.Erase(points[0]);
  object.Erase(points[1]);
  EXPECT_EQ(test::ReferenceBetti(object).components, 2);
}

TEST(ParallelRemoval, SplitsAnObjectWithoutCondition4) {
  ExpectSplits({{0, 0, 0}, {1, -1, -1}, {1, -1, 1}, {1, 1, -1}}, [](NeighborMask mask) {
    return test::ReferenceIsBorderPoint(mask, kDirection) && IsSimpleNonEnd(mask) &&
           test::ReferenceCondition3(mask, kDirection);
  });
}

TEST(ParallelRemoval, SplitsAnObjectWithoutCondition3) {
  ExpectSplits({{0, 0, 0}, {1, -1, -1}, {0, -2, 0}, {1, 1, 1}, {2, 0, 0}},
               BorderSimpleNonEndWithSequel);
}

// Every tetrahedron has four diagonal edges, one along each space diagonal.
TEST(ParallelRemoval, EveryTetrahedronHasAnEdgeAlongTheDirection) {
  for (const Clique& clique : CliquesOf(4, {kAllNeighbors})) {
    const bool along = std::ranges::any_of(clique, [&](const Member& a) {
      return std::ranges::any_of(clique, [&](const Member& b) { return b.point - a.point == kD; });
    });
    EXPECT_TRUE(along);
  }
  EXPECT_EQ(CliquesOf(4, {kAllNeighbors}).size(), 6u);
  EXPECT_EQ(CliquesOf(3, {kAllNeighbors}).size(), 12u);
  EXPECT_EQ(CliquesOf(2, {kAllNeighbors}).size(), 7u);
}

}  // namespace
}  // namespace bccskel
