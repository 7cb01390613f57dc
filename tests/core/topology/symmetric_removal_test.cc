#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "core/topology/neighborhood.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_cliques.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_point_set.h"

// The claims that symmetric thinning rests on: which simple points may go together.

namespace bccskel {
namespace {

using PointSet = std::set<LatticePoint>;

PointSet SimpleNonEnds(const test::ReferencePointSet& object) {
  PointSet simple;
  for (LatticePoint p : object.SortedPoints()) {
    if (IsSimpleNonEnd(object.NeighborsOf(p))) simple.insert(p);
  }
  return simple;
}

PointSet SimplePoints(const test::ReferencePointSet& object) {
  PointSet simple;
  for (LatticePoint p : object.SortedPoints()) {
    if (IsSimple(object.NeighborsOf(p))) simple.insert(p);
  }
  return simple;
}

test::ReferencePointSet Without(test::ReferencePointSet object, const PointSet& points) {
  for (LatticePoint p : points) object.Erase(p);
  return object;
}

// Any strict order within cliques will do: colors first makes many ties elsewhere.
int64_t ByColor(LatticePoint p) { return (p.x + p.y + p.z) & 3; }
int64_t ByHeight(LatticePoint p) { return 4 * p.z + ByColor(p); }

// Objects that lose their topology when all simple points that are no ends go at once, or when
// critical cliques of one size are overlooked.
struct Counterexample {
  std::vector<LatticePoint> object;
  PointSet removed;
  int components_left;
};
const Counterexample kPairs = {
    {{0, 0, 0}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}, {{0, 0, 0}, {-1, -1, 1}}, 2};
const Counterexample kTriple = {
    {{0, 0, 0}, {1, 1, -1}, {0, 2, 0}}, {{0, 0, 0}, {1, 1, -1}, {0, 2, 0}}, 0};
const Counterexample kQuadruple = {{{0, 0, 0}, {-1, -1, 1}, {-2, 0, 0}, {-1, -1, -1}},
                                   {{0, 0, 0}, {-1, -1, 1}, {-2, 0, 0}, {-1, -1, -1}},
                                   0};

TEST(SymmetricRemoval, WithoutTheCliqueRuleTopologyIsLost) {
  for (const Counterexample& example : {kPairs, kTriple, kQuadruple}) {
    const test::ReferencePointSet object(example.object);
    EXPECT_EQ(test::ReferenceBetti(object).components, 1);
    const PointSet simple = SimpleNonEnds(object);
    EXPECT_TRUE(std::ranges::includes(simple, example.removed));
    EXPECT_EQ(test::ReferenceBetti(Without(object, example.removed)).components,
              example.components_left);
    const PointSet left = test::ReferenceRuleB(object, simple, ByColor);
    EXPECT_EQ(test::ReferenceBetti(Without(object, left)), test::ReferenceBetti(object));
    EXPECT_FALSE(left.empty());
  }
}

// So each of the three steps is needed: smaller cliques do not warn of the larger ones.
TEST(SymmetricRemoval, CriticalCliquesOfOneSizeNeedNoCriticalOnesOfAnother) {
  const test::ReferencePointSet triangle(kTriple.object), tetrahedron(kQuadruple.object);
  const auto is_critical = [](const test::ReferencePointSet& object,
                              std::vector<LatticePoint> clique) {
    return !test::HasContractibleLink(object, clique);
  };
  const std::vector<LatticePoint>& t = kTriple.object;
  EXPECT_TRUE(is_critical(triangle, t));
  EXPECT_FALSE(is_critical(triangle, {t[0], t[1]}) || is_critical(triangle, {t[1], t[2]}) ||
               is_critical(triangle, {t[0], t[2]}));
  const std::vector<LatticePoint>& q = kQuadruple.object;
  EXPECT_TRUE(is_critical(tetrahedron, q));
  for (size_t a = 0; a < 4; ++a) {
    for (size_t b = 0; b < a; ++b) EXPECT_FALSE(is_critical(tetrahedron, {q[a], q[b]}));
    EXPECT_FALSE(is_critical(tetrahedron, {q[a], q[(a + 1) % 4], q[(a + 2) % 4]}));
  }
}

class SymmetricRemovalLaw : public testing::TestWithParam<uint64_t> {
 protected:
  test::ReferencePointSet Object() const {
    const uint64_t seed = GetParam();
    const double density = 0.15 + 0.7 * static_cast<double>(seed) / 59;
    return test::ReferencePointSet(test::RandomCloud(seed, {6, 6, 6}, density));
  }
  // Candidates may be any points.
  PointSet SomeOf(const PointSet& points) const {
    const std::vector<LatticePoint> all(points.begin(), points.end());
    const auto some = test::RandomSubset(GetParam(), all, GetParam() % 3 == 0 ? 0.7 : 1);
    return {some.begin(), some.end()};
  }
};

TEST_P(SymmetricRemovalLaw, WhatRuleBLeavesGoesInAnyOrderEachPointSimpleAtItsTurn) {
  const test::ReferencePointSet object = Object();
  const PointSet left = test::ReferenceRuleB(object, SomeOf(SimpleNonEnds(object)), ByHeight);
  std::mt19937_64 random(GetParam());
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<LatticePoint> order(left.begin(), left.end());
    std::shuffle(order.begin(), order.end(), random);
    test::ReferencePointSet rest = object;
    for (LatticePoint p : order) {
      ASSERT_TRUE(IsSimple(rest.NeighborsOf(p)));
      rest.Erase(p);
    }
    EXPECT_EQ(test::ReferenceBetti(rest), test::ReferenceBetti(object));
  }
}

TEST_P(SymmetricRemovalLaw, RuleCIsSafeTooAndTakesNoMorePoints) {
  const test::ReferencePointSet object = Object();
  const PointSet simple = SomeOf(SimpleNonEnds(object));
  const PointSet b = test::ReferenceRuleB(object, simple, ByColor);
  const PointSet c = test::ReferenceRuleC(object, simple, ByColor);
  EXPECT_TRUE(std::ranges::includes(b, c));
  EXPECT_EQ(test::ReferenceBetti(Without(object, c)), test::ReferenceBetti(object));
}

// Without Condition 2, for the topological kernel.
TEST_P(SymmetricRemovalLaw, EndPointsMayTakePart) {
  const test::ReferencePointSet object = Object();
  const PointSet left = test::ReferenceRuleB(object, SomeOf(SimplePoints(object)), ByColor);
  EXPECT_EQ(test::ReferenceBetti(Without(object, left)), test::ReferenceBetti(object));
}

TEST_P(SymmetricRemovalLaw, TheLowestSimplePointAlwaysGoes) {
  const test::ReferencePointSet object = Object();
  const PointSet simple = SimpleNonEnds(object);
  if (simple.empty()) return;
  const PointSet left = test::ReferenceRuleB(object, simple, ByHeight);
  EXPECT_TRUE(left.contains(*std::ranges::min_element(simple, {}, ByHeight)));
}

// Stubble and rule B in one pass: a stubble point's neighbor is neither simple nor an end point,
// and it has no other neighbor.
TEST_P(SymmetricRemovalLaw, StubbleMayGoInTheSamePass) {
  const test::ReferencePointSet object = Object();
  PointSet gone = test::ReferenceRuleB(object, SomeOf(SimpleNonEnds(object)), ByColor);
  for (LatticePoint p : object.SortedPoints()) {
    const bool stubble = GetParam() % 2 == 0 ? test::ReferenceIsStubbleKeepTwo(object, p)
                                             : test::ReferenceIsStubble(object, p);
    if (stubble) gone.insert(p);
  }
  EXPECT_EQ(test::ReferenceBetti(Without(object, gone)), test::ReferenceBetti(object));
}

INSTANTIATE_TEST_SUITE_P(Seeds, SymmetricRemovalLaw, testing::Range<uint64_t>(0, 60));

}  // namespace
}  // namespace bccskel
