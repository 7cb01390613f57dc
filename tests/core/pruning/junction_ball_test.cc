#include "core/pruning/junction_ball.h"

#include <algorithm>
#include <vector>

#include "gtest/gtest.h"

namespace bccskel {
namespace {

constexpr LatticePoint kCenter = {200, 200, 200};
constexpr float kRadius = 70;

ThinSet Center() {
  ThinSet set({VolumeOfPoints({}), {}});
  set.Add(kCenter, kRadius);
  return set;
}

// Steps of two units from the center.
LatticePoint At(int32_t x, int32_t y, int32_t z) {
  return kCenter + LatticePoint{2 * x, 2 * y, 2 * z};
}

TEST(JunctionBall, EndsWhereCurvesLeaveIt) {
  ThinSet set = Center();
  for (int32_t n = 1; n <= 40; ++n) {
    set.Add(At(-n, 0, 0), kRadius);
    set.Add(At(n, 0, 0), 20);
    if (n <= 10) set.Add(At(0, n, 0), 10);
  }
  const JunctionBall ball(set, kCenter);
  std::vector<LatticePoint> exits;
  for (size_t exit : ball.exits()) exits.push_back(ball.visited()[exit].p);
  EXPECT_EQ(exits.size(), 3U);
  for (LatticePoint p : {At(-28, 0, 0), At(28, 0, 0), At(0, 10, 0)}) {
    EXPECT_NE(std::ranges::find(exits, p), exits.end());
  }
  EXPECT_EQ(ball.visited()[ball.body()].p, At(-28, 0, 0));
  EXPECT_EQ(ball.ThickestLimb(set), 20);
  EXPECT_EQ(ball.WayTo(ball.body()).size(), 29U);
}

// Of a ball that is full of surfaces only some exits would be found.
TEST(JunctionBall, HasNoExitsIfItIsFull) {
  ThinSet set = Center();
  for (int32_t n = 0; n <= 40; ++n) {
    for (int32_t m = 0; m <= 40; ++m) {
      if (n > 0 || m > 0) set.Add(At(n, m, 0), 20);
      if (m > 0) set.Add(At(n, 0, m), 20);
    }
  }
  const JunctionBall ball(set, kCenter);
  EXPECT_TRUE(ball.exits().empty());
}

}  // namespace
}  // namespace bccskel
