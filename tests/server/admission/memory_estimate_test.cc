#include "server/admission/memory_estimate.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/volume_headers.h"

namespace bccskel::server {
namespace {

VolumeHeader PlanesOf(LatticeExtent extent) {
  return *test::MakePlanesHeader(extent, Placement(), VolumeLimits());
}

TEST(MemoryEstimate, GrowsWithTheDeclaredBox) {
  const uint64_t small = BytesToSkeletonize(PlanesOf({16, 16, 16}), 1000);
  const uint64_t large = BytesToSkeletonize(PlanesOf({256, 256, 256}), 1000);
  EXPECT_GT(large, small + 100 * (BoxBrickCount({256, 256, 256}) - BoxBrickCount({16, 16, 16})));
}

TEST(MemoryEstimate, IsThatOfTheDeclaredBricksWhereTheyAreDeclared) {
  const VolumeHeader sparse = *CompleteVolumeHeader({.encoding = VolumeEncoding::kBricks,
                                                     .extent = {1 << 20, 1 << 20, 1 << 20},
                                                     .placement = {},
                                                     .declared_bricks = 1},
                                                    VolumeLimits());
  EXPECT_LT(BytesToSkeletonize(sparse, 240), uint64_t{64} << 20);
}

TEST(MemoryEstimate, SaturatesInsteadOfWrapping) {
  VolumeHeader header = PlanesOf({16, 16, 16});
  header.max_bricks = std::numeric_limits<uint64_t>::max();
  EXPECT_EQ(BytesToSkeletonize(header, 1), std::numeric_limits<uint64_t>::max());
}

TEST(MemoryEstimate, OfADecodedVolumeIsNotMoreThanThatOfItsDeclaration) {
  const VolumeHeader header = PlanesOf({32, 32, 32});
  VolumeBuilder builder(header.extent);
  builder.Add({1, 1, 1});
  EXPECT_LT(BytesToSkeletonize(*std::move(builder).Build()), BytesToSkeletonize(header, 8192));
}

TEST(Threads, SmallVolumesGetOne) {
  EXPECT_EQ(ThreadsFor(1, 8, 16), 1);
  EXPECT_EQ(ThreadsFor(kSmallJobBricks, 0, 16), 1);
}

TEST(Threads, LargeVolumesGetWhatTheyWantWithinTheShare) {
  EXPECT_EQ(ThreadsFor(kSmallJobBricks + 1, 0, 16), 16);
  EXPECT_EQ(ThreadsFor(kSmallJobBricks + 1, 4, 16), 4);
  EXPECT_EQ(ThreadsFor(kSmallJobBricks + 1, 32, 16), 16);
}

}  // namespace
}  // namespace bccskel::server
