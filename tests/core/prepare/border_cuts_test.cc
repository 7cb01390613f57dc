#include "core/prepare/border_cuts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/exec/machine_memory.h"
#include "core/prepare/beyond_border.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

BorderCuts CutsOf(const std::function<bool(double, double, double)>& is_in) {
  const Volume object = test::VolumeWhere({48, 32, 32}, is_in);
  exec::MachineMemory memory;
  const Volume space = *ContinueBeyond(kAllFaces, object, BorderPoints::kLastOfLattice, memory);
  const DistanceField distance = *MeasureIn(space, object, DistanceKind::kEuclidean, {});
  return FindBorderCuts(space, object, distance);
}

TEST(BorderCuts, AreThoseAcrossFlatLimbs) {
  const BorderCuts cuts = CutsOf(
      [](double, double y, double z) { return std::hypot((y - 32) / 16, (z - 32) / 6) <= 1; });
  ASSERT_EQ(cuts.middles.size(), 2u);
  for (const LatticePoint middle : cuts.middles) {
    EXPECT_TRUE(middle.x == 0 || middle.x == 95) << middle.x;
    EXPECT_LE(std::hypot(middle.y - 32, middle.z - 32), 2);
    EXPECT_EQ(cuts.MiddleBeside(middle, 8), std::nullopt);
    EXPECT_EQ(cuts.MiddleBeside(middle + LatticePoint{0, 8, 0}, 8), middle);
  }
}

TEST(BorderCuts, AreNotThoseAlongLimbsOfBodiesAndOfRoundLimbs) {
  const auto count = [](const auto& is_in) { return CutsOf(is_in).middles.size(); };
  EXPECT_EQ(count([](double x, double y, double z) {
              return std::hypot(std::max(std::abs(x - 48) - 30, 0.0), y - 32, z) <= 8;
            }),
            0u);
  EXPECT_EQ(
      count([](double x, double y, double z) { return std::hypot(x - 16, y - 32, z - 32) <= 19; }),
      0u);
  EXPECT_EQ(count([](double, double y, double z) { return std::hypot(y - 32, z - 32) <= 9; }), 0u);
}

}  // namespace
}  // namespace bccskel
