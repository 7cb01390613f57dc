#include "core/certificate/neighbor_planes.h"

#include <gtest/gtest.h>

#include "core/exec/instruction_sets.h"
#include "core/volume/volume.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

BrickSurroundings SurroundingsOf(const Volume& object, BrickIndex n) {
  BrickSurroundings bricks{object.bricks()[n], {}};
  for (size_t position = 0; position < kNeighborCount; ++position) {
    bricks.around[position] = object.padded_bricks()[object.neighbors()[n][position]];
  }
  return bricks;
}

void ExpectPlanesToShowNeighbors(const Volume& object, BrickIndex n) {
  const BrickCoordinates brick = object.keys()[n].coordinates();
  const NeighborPlanes planes = FindNeighborPlanes(brick.sublattice, SurroundingsOf(object, n));
  for (int d = 0; d < kNeighborCount; ++d) {
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      const LatticePoint p = PointOf(brick, bit) + Direction(d).offset();
      ASSERT_EQ(planes[static_cast<size_t>(d)].Test(bit), object.Contains(p))
          << "brick " << n << " d " << d;
    }
  }
}

PositionMask ReferenceTouchedBricks(const Volume& object, BrickIndex n) {
  const BrickCoordinates brick = object.keys()[n].coordinates();
  PositionMask touched = 0;
  object.bricks()[n].ForEachSetBit([&](int bit) {
    for (int d = 0; d < kNeighborCount; ++d) {
      const LatticePoint p = PointOf(brick, bit) + Direction(d).offset();
      if (!object.Contains(p)) continue;
      for (int position = 0; position < kNeighborCount; ++position) {
        if (AddressOf(p).brick == NeighborBrick(brick, position)) touched |= 1u << position;
      }
    }
  });
  return touched;
}

class NeighborPlanesOn : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_TRUE(exec::ChooseInstructionSet(GetParam())); }
  void TearDown() override { exec::ChooseInstructionSet(""); }
};

TEST_P(NeighborPlanesOn, SayOfEachPointWhetherItsNeighborIsInTheObject) {
  const Volume object = VolumeOfPoints(test::RandomCloud(11, {40, 11, 21}, 0.4));
  for (BrickIndex n = 0; n < object.brick_count(); ++n) ExpectPlanesToShowNeighbors(object, n);
}

TEST_P(NeighborPlanesOn, TouchedBricksAreThoseThatHoldNeighbors) {
  for (double density : {0.002, 0.01, 0.05, 0.3}) {
    const Volume object = VolumeOfPoints(test::RandomCloud(12, {70, 18, 33}, density));
    for (BrickIndex n = 0; n < object.brick_count(); ++n) {
      const Sublattice sublattice = object.keys()[n].sublattice();
      ASSERT_EQ(FindTouchedBricks(sublattice, object.padded_bricks(), n, object.neighbors()[n]),
                ReferenceTouchedBricks(object, n))
          << "brick " << n << " density " << density;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllInstructionSets, NeighborPlanesOn,
                         testing::ValuesIn(exec::SupportedInstructionSets()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace bccskel
