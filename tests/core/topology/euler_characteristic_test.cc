#include <gtest/gtest.h>

#include "core/topology/neighborhood.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"

namespace bccskel {
namespace {

// The surface between object and background cells is a closed manifold: its faces are the mixed
// pairs of adjacent points, its edges the mixed triples, its vertices the mixed quadruples.
int64_t EulerCharacteristicOfSurface(const test::ReferencePointSet& object) {
  int64_t mixed[5] = {};
  object.ForEachLatticePointOfBox([&](LatticePoint p) {
    for (unsigned a = 0; a < kNeighborCount; ++a) {
      for (unsigned set = 0; set < 1u << a; ++set) {
        // Cliques {p} + set + a whose least point is p.
        const unsigned others = set | 1u << a;
        if (std::popcount(others) > 3) continue;
        int inside = object.Contains(p);
        bool is_clique = true;
        for (unsigned n = 0; n < kNeighborCount && is_clique; ++n) {
          if ((others >> n & 1) == 0) continue;
          const unsigned rest = others & ~(1u << n);
          is_clique = p < p + kDirections14[n] && (rest & ~kSharedNeighbors[n]) == 0;
          inside += object.Contains(p + kDirections14[n]);
        }
        const int size = 1 + std::popcount(others);
        if (is_clique && inside != 0 && inside != size) ++mixed[size];
      }
    }
  });
  return mixed[4] - mixed[3] + mixed[2];
}

TEST(EulerCharacteristicLaw, IsHalfThatOfTheBoundarySurface) {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const double density = 0.1 + 0.1 * static_cast<double>(seed);
    const test::ReferencePointSet object(test::RandomCloud(seed, {3, 3, 3}, density));
    EXPECT_EQ(EulerCharacteristicOfSurface(object), 2 * test::ReferenceEulerCharacteristic(object));
  }
}

TEST(EulerCharacteristicLaw, ChangesWithAPointByOneLessThatOfItsLink) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto points = test::RandomCloud(seed, {4, 4, 4}, 0.5);
    if (points.empty()) continue;
    test::ReferencePointSet object(points);
    const LatticePoint p = points[points.size() / 2];
    const NeighborMask mask = object.NeighborsOf(p);
    const auto background = static_cast<NeighborMask>(mask ^ kAllNeighbors);
    if (mask == 0 || background == 0) continue;
    const int64_t before = test::ReferenceEulerCharacteristic(object);
    object.Erase(p);
    const int link = ComponentsIn(mask) - (ComponentsIn(background) - 1);
    EXPECT_EQ(before - test::ReferenceEulerCharacteristic(object), 1 - link);
  }
}

}  // namespace
}  // namespace bccskel
