#include <gtest/gtest.h>

#include <vector>

#include "core/topology/neighborhood.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/reference_thinner.h"

namespace bccskel {
namespace {

// The smallest object on which the directional rule leaves a simple point that is no end point.
const std::vector<LatticePoint> kStuck = {{0, 0, 0},   {0, 0, 2},  {0, 2, -2},
                                          {1, -1, -1}, {1, -1, 3}, {1, 1, 1},
                                          {2, 2, -2},  {2, 2, 0},  {0, 2, 0}};

TEST(Thinness, TheStuckObjectHasASimplePointThatNoDirectionRemoves) {
  const test::ReferencePointSet object(kStuck);
  const NeighborMask mask = object.NeighborsOf({1, 1, 1});
  EXPECT_EQ(NeighborsIn(mask), 4);
  EXPECT_TRUE(IsSimpleNonEnd(mask));
  EXPECT_EQ(test::ReferenceRemovableDirections(mask), 0);
}

TEST(Thinness, TheStuckObjectStaysWithoutCleanupAndIsThinWithIt) {
  const Volume object = VolumeOfPoints(test::Translated(kStuck, {2, 2, 2}));
  ThinningOptions options;
  options.cleanup = ThinnessCleanup::kOff;
  options.stubble = StubblePolicy::kNone;
  const test::ReferencePointSet stuck(test::ReferenceThin(object, options));
  EXPECT_TRUE(stuck.Contains({3, 3, 3}));
  EXPECT_GT(test::ReferenceSimpleNonEndPoints(stuck), 0u);
  options.cleanup = ThinnessCleanup::kOn;
  const test::ReferencePointSet thin(test::ReferenceThin(object, options));
  EXPECT_EQ(test::ReferenceSimpleNonEndPoints(thin), 0u);
  EXPECT_EQ(test::ReferenceBetti(thin), test::ReferenceBetti(stuck));
}

// So no removal within a subfield changes the neighborhood of another point of it.
TEST(Thinness, NeighborsNeverShareASubfield) {
  for (LatticePoint offset : kDirections14) {
    EXPECT_NE((offset.x + offset.y + offset.z + 8) % 4, 0);
  }
}

TEST(ThinnessLaw, CleanupLeavesNoSimpleNonEndPointAndKeepsTheTopology) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const double density = 0.2 + 0.01 * static_cast<double>(seed);
    const Volume object = VolumeOfPoints(test::RandomCloud(seed, {6, 6, 6}, density));
    const test::ReferencePointSet thin(test::ReferenceThin(object, {}));
    EXPECT_EQ(test::ReferenceSimpleNonEndPoints(thin), 0u);
    EXPECT_EQ(test::ReferenceBetti(thin), test::ReferenceBetti(test::ReferencePointSet(object)));
  }
}

}  // namespace
}  // namespace bccskel
