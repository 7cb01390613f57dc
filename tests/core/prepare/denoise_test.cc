#include "core/prepare/denoise.h"

#include <gtest/gtest.h>

#include "core/exec/instruction_sets.h"
#include "core/lattice/directions.h"
#include "tests/core/prepare/reference_prepare.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using test::Points;

ChangedVolume Denoised(const Volume& object, int threads = 1) {
  test::TeamContext context(threads);
  return Denoise(object, context).value();
}

std::vector<Points> Objects() {
  std::vector<Points> objects;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const double density = 0.3 + 0.02 * static_cast<double>(seed);
    objects.push_back(test::Sorted(test::RandomCloud(seed, {37, 13, 18}, density)));
  }
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const auto blob = test::RandomBlob(seed, {40, 20, 20}, 6, 14);
    objects.push_back(test::Sorted(test::WithNoisyBoundary(seed, blob, 0.3)));
  }
  return objects;
}

TEST(DenoiseLaw, GivesEveryPointTheMajorityOfItselfAndItsNeighborsOnAnyInstructionSet) {
  for (const Points& points : Objects()) {
    const Points expected = test::ReferenceDenoised(points);
    for (const std::string& name : exec::SupportedInstructionSets()) {
      ASSERT_TRUE(exec::ChooseInstructionSet(name));
      ASSERT_EQ(Denoised(VolumeOfPoints(points)).object.SortedPoints(), expected) << name;
    }
    exec::ChooseInstructionSet("");
  }
}

TEST(DenoiseLaw, IsTheSameForAnyNumberOfThreads) {
  const Volume object = VolumeOfPoints(test::RandomCloud(3, {64, 40, 40}, 0.5));
  const ChangedVolume expected = Denoised(object);
  for (int threads : {2, 3, 8}) {
    const ChangedVolume changed = Denoised(object, threads);
    EXPECT_TRUE(changed.object == expected.object);
    EXPECT_EQ(changed.points_added, expected.points_added);
    EXPECT_EQ(changed.points_removed, expected.points_removed);
  }
}

// Of two opposite neighbors of a background point, one is background.
TEST(Denoise, AddsNothingToABall) {
  Points ball;
  for (Sublattice s : kSublattices) {
    for (int32_t n = 0; n < 32 * 32 * 32; ++n) {
      const LatticePoint p = PointAt(s, n % 32, n / 32 % 32, n / 32 / 32);
      const LatticePoint way = p - LatticePoint{31, 30, 29};
      if (way.x * way.x + way.y * way.y + way.z * way.z <= 600) ball.push_back(p);
    }
  }
  EXPECT_EQ(Denoised(VolumeOfPoints(ball)).points_added, 0u);
}

TEST(DenoiseLaw, CountsWhatItAddsAndRemoves) {
  for (const Points& points : Objects()) {
    const ChangedVolume changed = Denoised(VolumeOfPoints(points));
    uint64_t stayed = 0;
    for (LatticePoint p : points) stayed += changed.object.Contains(p) ? 1 : 0;
    EXPECT_EQ(changed.points_removed, points.size() - stayed);
    EXPECT_EQ(changed.points_added, changed.object.PointCount() - stayed);
  }
}

// The eight diagonal neighbors of a point, in bricks around one that is not stored.
TEST(Denoise, FillsAPointInABrickWithoutPoints) {
  for (LatticePoint p : {LatticePoint{32, 8, 16}, {31, 7, 15}, {33, 9, 17}, {62, 14, 30}}) {
    Points around;
    for (int d = 0; d < 8; ++d) around.push_back(p + Direction(d).offset());
    EXPECT_TRUE(Denoised(VolumeOfPoints(around)).object.Contains(p)) << p.x;
  }
}

TEST(Denoise, AddsNoPointOutsideTheExtent) {
  const Volume box = test::FullVolume({17, 5, 9});
  const ChangedVolume changed = Denoised(box);
  EXPECT_EQ(changed.points_added, 0u);
  EXPECT_TRUE(Volume::Create(box.extent(), {},
                             {changed.object.keys().begin(), changed.object.keys().end()},
                             {changed.object.bricks().begin(), changed.object.bricks().end()})
                  .ok());
}

TEST(Denoise, DestroysALine) {
  EXPECT_TRUE(
      Denoised(VolumeOfPoints(Points{{4, 4, 4}, {5, 5, 5}, {6, 6, 6}, {7, 7, 7}})).object.empty());
}

TEST(Denoise, OfNothingIsNothing) { EXPECT_TRUE(Denoised(Volume()).object.empty()); }

TEST(Denoise, StopsWhenTheJobIsCancelled) {
  const exec::Context context = test::Stopped();
  const Volume object = VolumeOfPoints(test::RandomCloud(3, {20, 20, 20}, 0.5));
  EXPECT_EQ(Denoise(object, context).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel
