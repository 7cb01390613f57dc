#include <gtest/gtest.h>

#include "core/certificate/certificate.h"
#include "core/exec/instruction_sets.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/sanitized.h"

namespace bccskel {
namespace {

uint64_t Count(const std::vector<LatticePoint>& points) {
  return CountSimplePoints(VolumeOfPoints(points), SimplePoints::kNonEnd, {}, {});
}

TEST(SimpleNonEndPoints, AreNotTheEndsOfALineButTheCornersOfATriangle) {
  EXPECT_EQ(Count({{4, 4, 4}, {5, 5, 5}, {6, 6, 6}}), 0u);
  EXPECT_EQ(Count({{4, 4, 4}, {5, 5, 5}, {6, 4, 4}}), 3u);
  EXPECT_EQ(Count({{4, 4, 4}}), 0u);
}

TEST(SimpleNonEndPointsLaw, AgreeWithFloodFillOfNeighborhoods) {
  for (uint64_t seed = 0; seed < 40; seed += test::kStride) {
    const auto points = test::RandomCloud(seed, {19, 6, 11}, static_cast<double>(seed % 20) / 19.0);
    const uint64_t expected = test::ReferenceSimpleNonEndPoints(test::ReferencePointSet(points));
    for (const std::string& name : exec::SupportedInstructionSets()) {
      ASSERT_TRUE(exec::ChooseInstructionSet(name));
      ASSERT_EQ(Count(points), expected) << "seed " << seed << " on " << name;
    }
    exec::ChooseInstructionSet("");
  }
}

TEST(SimplePointsLaw, CountEndPointsWhereAskedAndNeverThoseSpared) {
  for (uint64_t seed = 0; seed < 20; seed += test::kStride) {
    const auto points = test::RandomCloud(seed, {19, 6, 11}, static_cast<double>(seed) / 19.0);
    const auto spared = test::RandomSubset(seed, points, 0.3);
    const test::ReferencePointSet object(points), kept(spared);
    uint64_t all = 0, non_end = 0;
    for (LatticePoint p : points) {
      if (!test::ReferenceCondition1(object.NeighborsOf(p)) || kept.Contains(p)) continue;
      ++all;
      non_end += test::ReferenceCondition2(object.NeighborsOf(p)) ? 1 : 0;
    }
    const Volume volume = VolumeOfPoints(points), left_out = VolumeOfPoints(spared);
    ASSERT_EQ(CountSimplePoints(volume, SimplePoints::kAll, left_out, {}), all) << seed;
    ASSERT_EQ(CountSimplePoints(volume, SimplePoints::kNonEnd, left_out, {}), non_end) << seed;
  }
}

TEST(SimpleNonEndPoints, AreAsManyForAnyNumberOfThreads) {
  const Volume object = VolumeOfPoints(test::RandomCloud(5, {64, 32, 32}, 0.3));
  const uint64_t expected = CountSimplePoints(object, SimplePoints::kNonEnd, {}, {});
  for (int threads : {2, 3, 8}) {
    test::TeamContext context(threads);
    EXPECT_EQ(CountSimplePoints(object, SimplePoints::kNonEnd, {}, context), expected);
  }
}

}  // namespace
}  // namespace bccskel
