#include <gtest/gtest.h>

#include "core/certificate/certificate.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/sanitized.h"

namespace bccskel {
namespace {

using test::RandomCloud;
using test::ReferenceEulerCharacteristic;
using test::ReferencePointSet;

int64_t Chi(const std::vector<LatticePoint>& points) {
  return CountEulerCharacteristic(VolumeOfPoints(points), {});
}

TEST(EulerCharacteristic, OfSmallCliquesIsOne) {
  EXPECT_EQ(Chi({}), 0);
  EXPECT_EQ(Chi({{4, 4, 4}}), 1);
  EXPECT_EQ(Chi({{4, 4, 4}, {5, 5, 5}}), 1);
  EXPECT_EQ(Chi({{4, 4, 4}, {5, 5, 5}, {6, 4, 4}}), 1);
  EXPECT_EQ(Chi({{4, 4, 4}, {5, 5, 5}, {6, 4, 4}, {5, 5, 3}}), 1);
  EXPECT_EQ(Chi({{4, 4, 4}, {8, 8, 8}}), 2);
}

TEST(EulerCharacteristic, OfAPointsFourteenNeighborsIsThatOfASphere) {
  std::vector<LatticePoint> shell;
  for (LatticePoint offset : kDirections14) shell.push_back(LatticePoint{16, 8, 16} + offset);
  EXPECT_EQ(Chi(shell), 2);
  shell.push_back({16, 8, 16});
  EXPECT_EQ(Chi(shell), 1);
}

TEST(EulerCharacteristicLaw, EqualsPointsMinusPairsPlusTriplesMinusQuadruples) {
  for (uint64_t seed = 0; seed < 60; seed += test::kStride) {
    const auto points = RandomCloud(seed, {19, 6, 11}, static_cast<double>(seed % 20) / 19.0);
    const int64_t expected = ReferenceEulerCharacteristic(ReferencePointSet(points));
    ASSERT_EQ(Chi(points), expected) << "seed " << seed;
  }
}

// chi(A or B) = chi(A) + chi(B) - chi(A and B) holds where the clique complex of the union is the
// union of the complexes: for two halves that share a slab two lattice planes thick.
TEST(EulerCharacteristicLaw, IsAdditiveOverOverlappingHalves) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const auto points = RandomCloud(seed + 100, {40, 10, 20}, 0.5);
    std::vector<LatticePoint> left, right, both;
    for (LatticePoint p : points) {
      if (p.x <= 32) left.push_back(p);
      if (p.x >= 31) right.push_back(p);
      if (p.x == 31 || p.x == 32) both.push_back(p);
    }
    EXPECT_EQ(Chi(points), Chi(left) + Chi(right) - Chi(both)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace bccskel
