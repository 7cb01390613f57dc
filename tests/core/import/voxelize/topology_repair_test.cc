// Sharp edges and crossing parts, where a sampling hangs together by chance.
#include "core/import/voxelize/topology_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/core/import/voxelize/voxelized.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using testing::Blade;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Turned;

uint64_t PointsApart(const Volume& a, const Volume& b) {
  uint64_t apart = 0;
  a.ForEachPoint([&](LatticePoint p) { apart += !b.Contains(p); });
  b.ForEachPoint([&](LatticePoint p) { apart += !a.Contains(p); });
  return apart;
}

VoxelizeResult Sampled(const TriangleMesh& mesh, TopologyCheck topology) {
  return test::Voxelized(mesh,
                         {.points = 20000, .thin_parts = ThinParts::kSample, .topology = topology});
}

TEST(TopologyRepair, BladesHaveTheTopologyOfTheirMeshInEveryPose) {
  std::mt19937 random(1);
  int different = 0;
  for (int n = 0; n < 24; ++n) {
    const TriangleMesh mesh = Turned(Blade(0.2 + 0.05 * (n % 4)), random);
    const VoxelizeResult plain = Sampled(mesh, TopologyCheck::kSkip);
    const VoxelizeResult result = Sampled(mesh, TopologyCheck::kCompare);
    EXPECT_THAT(result.warnings, IsEmpty());
    EXPECT_EQ(result.topology, (BettiNumbers{1, 0, 0}));
    EXPECT_EQ(CountBettiNumbers(result.volume, {}).value(), (BettiNumbers{1, 0, 0}));
    const BettiNumbers found = CountBettiNumbers(plain.volume, {}).value();
    const uint64_t apart = PointsApart(plain.volume, result.volume);
    EXPECT_EQ(apart == 0, found == (BettiNumbers{1, 0, 0}));
    EXPECT_LE(apart, 20u + 4 * static_cast<uint64_t>(found.loops));
    different += apart > 0;
  }
  EXPECT_GE(different, 8);  // or the test shows nothing
}

TEST(TopologyRepair, BladesThatCrossHaveNoLoopsInAnyPose) {
  std::mt19937 random(2);
  int different = 0;
  for (int n = 0; n < 12; ++n) {
    const TriangleMesh blade = Turned(Blade(0.2 + 0.05 * (n % 4)), random);
    TriangleMesh mesh = blade;
    for (const auto& [x, y, z] : blade.vertices) mesh.vertices.push_back({y, z, x});
    for (auto [a, b, c] : blade.triangles) mesh.triangles.push_back({a + 6, b + 6, c + 6});
    const VoxelizeResult plain = Sampled(mesh, TopologyCheck::kSkip);
    const VoxelizeResult result = Sampled(mesh, TopologyCheck::kCompare);
    EXPECT_THAT(result.warnings, Contains(HasSubstr("but the mesh has 2 components, 0 loops")));
    EXPECT_EQ(result.topology, (BettiNumbers{1, 0, 0}));
    different += PointsApart(plain.volume, result.volume) > 0;
  }
  EXPECT_GE(different, 4);  // or the test shows nothing
}

// A cube of lattice points with a spine of single points, and a handle that is one point thick.
struct SpineAndHandle {
  VolumeBuilder builder{LatticeExtent{20, 20, 20}};
  std::vector<LatticePoint> spine;

  explicit SpineAndHandle(bool handle) {
    test::ForEachPointIn({{10, 10, 10}, {19, 19, 19}}, [&](LatticePoint p) { builder.Add(p); });
    for (int32_t x = 20; x < 34; x += 2) spine.push_back({x, 14, 14});
    for (const LatticePoint p : spine) builder.Add(p);
    if (!handle) return;
    for (int32_t y = 20; y < 26; y += 2) builder.Add({12, y, 12});
    for (int32_t x = 12; x < 18; x += 2) builder.Add({x, 26, 12});
    for (int32_t y = 20; y < 27; y += 2) builder.Add({18, y, 12});
  }
};

TEST(TopologyRepair, CutsAFalseHandleAndKeepsAThinLimb) {
  SpineAndHandle made(/*handle=*/true);
  const Volume sampling = std::move(made.builder).Build().value();
  const BettiNumbers found = CountBettiNumbers(sampling, {}).value();
  ASSERT_EQ(found, (BettiNumbers{1, 1, 0}));
  const Volume repaired = RepairTopology(sampling, found, {1, 0, 0}, {}).value();
  EXPECT_EQ(CountBettiNumbers(repaired, {}).value(), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(PointsApart(sampling, repaired), 1u);
  for (const LatticePoint p : made.spine) EXPECT_TRUE(repaired.Contains(p));
}

TEST(TopologyRepair, TakesAwayWhatIsTooMuchWherePartsTouch) {
  SpineAndHandle made(/*handle=*/true);
  const Volume sampling = std::move(made.builder).Build().value();
  const Volume repaired = RepairTopology(sampling, {1, 1, 0}, {2, 0, 0}, {}).value();
  EXPECT_EQ(CountBettiNumbers(repaired, {}).value(), (BettiNumbers{1, 0, 0}));
}

TEST(TopologyRepair, LeavesASamplingThatHasNothingTooMuch) {
  SpineAndHandle made(/*handle=*/true);
  const Volume sampling = std::move(made.builder).Build().value();
  for (const BettiNumbers wanted : {BettiNumbers{1, 1, 1}, BettiNumbers{2, 2, 0}}) {
    EXPECT_EQ(RepairTopology(sampling, {1, 1, 0}, wanted, {}).value(), sampling);
  }
}

TEST(TopologyRepair, AWallThinnerThanCellsIsNamedWithItsRemedy) {
  std::mt19937 random(1);
  const TriangleMesh mesh = Turned(testing::Box({0, 0, 0}, {1, 1, 0.02}), random);
  const VoxelizeResult result =
      test::Voxelized(mesh, {.spacing = 0.05, .thin_parts = ThinParts::kSample});
  EXPECT_THAT(result.warnings, Contains(HasSubstr("cells 0.05 wide, so try --spacing 0.0")));
}

}  // namespace
}  // namespace bccskel
