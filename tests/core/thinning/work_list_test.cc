#include "core/thinning/work_list.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/exec/instruction_sets.h"

namespace bccskel {
namespace {

constexpr size_t kBricks = 3 * kDirtyGroup;

struct Bricks {
  std::vector<DirtyMask> bits = std::vector<DirtyMask>(kBricks);
  std::vector<uint8_t> groups = std::vector<uint8_t>(kBricks / kDirtyGroup);
  BrickLists found, end_points;

  Bricks() {
    found.Reserve(kBricks);
    end_points.Reserve(kBricks);
  }
  void Take(DirtyMask to_visit) {
    TakeDirty({bits.data(), groups.data()}, 0, kBricks, to_visit, found, end_points);
  }
  void Add(BrickIndex brick, DirtyMask some) {
    DirtyBricks{bits.data(), groups.data()}.Add(brick, some);
  }
};

std::vector<BrickIndex> In(const BrickLists& lists, Sublattice sublattice) {
  const auto list = lists.Of(sublattice);
  return {list.begin(), list.end()};
}

using List = std::vector<BrickIndex>;

TEST(WorkList, HoldsWhatIsLookedForOnceByItsSublatticeOnEveryInstructionSet) {
  for (const std::string& name : exec::SupportedInstructionSets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    Bricks bricks;
    bricks.bits[70] = kOddBrick;
    bricks.Add(3, 1 << 2);
    bricks.Add(40, 1 << 5);
    bricks.Add(70, 1 << 2);
    bricks.Take(1 << 2);
    EXPECT_EQ(In(bricks.found, Sublattice::kEven), List({3}));
    EXPECT_EQ(In(bricks.found, Sublattice::kOdd), List({70}));
    bricks.Take(1 << 2);
    EXPECT_EQ(In(bricks.found, Sublattice::kEven), List());
    EXPECT_EQ(In(bricks.found, Sublattice::kOdd), List());
    bricks.Take(1 << 5);
    EXPECT_EQ(In(bricks.found, Sublattice::kEven), List({40}));
  }
  exec::ChooseInstructionSet("");
}

TEST(WorkList, HoldsBricksThatAreAwakeInEveryPass) {
  Bricks bricks;
  bricks.Add(33, kAwake);
  for (int pass = 0; pass < 3; ++pass) {
    bricks.Take(static_cast<DirtyMask>(1 << pass));
    EXPECT_EQ(In(bricks.found, Sublattice::kEven), List({33}));
  }
}

TEST(WorkList, HoldsBricksForTheirEndPointsOnlyIfNothingElseIsToDo) {
  Bricks bricks;
  bricks.Add(5, kEndPointsDirty);
  bricks.Add(6, kEndPointsDirty | 1);
  bricks.Take(1);
  EXPECT_EQ(In(bricks.found, Sublattice::kEven), List({6}));
  EXPECT_EQ(In(bricks.end_points, Sublattice::kEven), List({5}));
  bricks.Take(1);
  EXPECT_EQ(In(bricks.end_points, Sublattice::kEven), List());
}

}  // namespace
}  // namespace bccskel
