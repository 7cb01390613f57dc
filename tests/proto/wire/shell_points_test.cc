#include "proto/wire/shell_points.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/random_objects.h"

namespace bccskel::wire {
namespace {

TEST(ShellPointsMessages, HoldEveryPointOnceInMessagesOf256KiB) {
  const Volume volume = VolumeOfPoints(test::RandomCloud(1, {40, 40, 40}, 0.5));
  std::vector<LatticePoint> all;
  for (const v1::ShellPoints& message : ShellPointsMessages(7, volume)) {
    EXPECT_EQ(message.shell(), 7);
    EXPECT_LE(message.ByteSizeLong(), size_t{256} * 1024);
    const auto points = PointsOf(message);
    ASSERT_TRUE(points.ok()) << points.status();
    all.insert(all.end(), points->begin(), points->end());
  }
  ASSERT_GT(all.size(), kMaxShellPointRows);
  std::ranges::sort(all);
  EXPECT_EQ(all, volume.SortedPoints());
}

TEST(ShellPointsMessages, StaySmallWherePointsLieFarApart) {
  constexpr int32_t kFar = 2 * kMaxExtentCells - 2;
  v1::ShellPoints message;
  for (size_t row = 0; row < kMaxShellPointRows; ++row) {
    const int32_t step = row % 2 == 0 ? kFar : -kFar;
    message.add_dx(step);
    message.add_dy(step);
    message.add_dz(step);
  }
  EXPECT_LE(message.ByteSizeLong(), size_t{256} * 1024);
  EXPECT_EQ((*PointsOf(message))[2], (LatticePoint{kFar, kFar, kFar}));
}

TEST(ShellPointsMessages, OfNothingAreNone) {
  EXPECT_TRUE(ShellPointsMessages(1, Volume()).empty());
}

TEST(ShellPoints, DamagedOnesAreRefused) {
  v1::ShellPoints message;
  message.add_dx(1);
  EXPECT_TRUE(absl::IsDataLoss(PointsOf(message).status()));
  message.add_dy(-1);
  message.add_dz(1);
  EXPECT_TRUE(absl::IsDataLoss(PointsOf(message).status()));
}

}  // namespace
}  // namespace bccskel::wire
