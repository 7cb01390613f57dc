#include "core/thinning/brick_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/distance/distance_field.h"
#include "core/thinning/open_shell.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

constexpr int kWorkers = 8;
// A ball, whose deep shells only the middle ranges hold.
struct Ball {
  Volume object = test::VolumeWhere({80, 80, 80}, [](int32_t x, int32_t y, int32_t z) {
    return (x - 80) * (x - 80) + (y - 80) * (y - 80) + (z - 80) * (z - 80) <= 79 * 79;
  });
  Shells shells = BuildShells(
      object, *ComputeDistance(object, DistanceKind::kEuclidean, exec::Context()), 1, {});

  bool Holds(size_t brick, int32_t shell) const {
    const Shells::Range range = shells.RangeOf(static_cast<BrickIndex>(brick));
    return range.first < shell + kShellsAtOnce && range.last >= shell;
  }
  // How many bricks of each worker hold points of the shells.
  std::vector<size_t> Work(const BrickShares& shares, int32_t shell) const {
    std::vector<size_t> work(kWorkers);
    for (int w = 0; w < kWorkers; ++w) {
      const exec::Share own = shares.Of(w);
      for (size_t n = own.begin; n < own.end; ++n) {
        work[static_cast<size_t>(w)] += Holds(n, shell) ? 1 : 0;
      }
    }
    return work;
  }
};

void ExpectAllOnce(const BrickShares& shares, size_t bricks) {
  size_t next = 0;
  for (int w = 0; w < kWorkers; ++w) {
    const exec::Share own = shares.Of(w);
    EXPECT_EQ(own.begin, next);
    for (size_t n = own.begin; n < own.end; ++n) {
      ASSERT_EQ(shares.OwnerOf(static_cast<BrickIndex>(n)), w) << "brick " << n;
    }
    next = own.end;
  }
  EXPECT_EQ(next, bricks);
}

void Move(BrickShares& shares, const Ball& ball, int32_t shell, size_t fewest) {
  for (int w = 0; w < kWorkers; ++w) shares.Count(w, ball.shells, shell);
  if (!shares.Uneven(fewest)) return;
  for (int w = 0; w < kWorkers; ++w) shares.Cut(w, ball.shells, shell, fewest);
  shares.Adopt();
}

TEST(BrickShares, BeginWithRangesOfEqualLength) {
  for (size_t bricks : {size_t{1}, size_t{31}, size_t{32}, size_t{1000}}) {
    ExpectAllOnce(BrickShares(bricks, kWorkers), bricks);
  }
}

TEST(BrickShares, MoveWithTheShells) {
  const Ball ball;
  const size_t bricks = ball.object.brick_count();
  BrickShares shares(bricks, kWorkers);
  for (int32_t shell = kShellsAtOnce; shell <= ball.shells.last(); shell += kShellsAtOnce) {
    Move(shares, ball, shell, 32);
    ExpectAllOnce(shares, bricks);
    const std::vector<size_t> work = ball.Work(shares, shell);
    size_t total = 0;
    for (size_t w : work) total += w;
    const size_t used = std::clamp<size_t>(total / 32, 1, kWorkers);
    EXPECT_LE(std::ranges::max(work), total / used * 4 / 3 + 2 * kDirtyGroup) << "shell " << shell;
  }
}

TEST(BrickShares, JoinInOne) {
  BrickShares shares(100, kWorkers);
  shares.JoinInOne();
  ExpectAllOnce(shares, 100);
  EXPECT_EQ(shares.Of(0).end, 100u);
}

}  // namespace
}  // namespace bccskel
