// How many points, how large, how far away, for how long; and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/import/mesh/mesh_file.h"
#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/core/import/mesh/test_data.h"
#include "tests/core/import/voxelize/voxelized.h"

namespace bccskel {
namespace {

using test::Voxelized;
using ::testing::AllOf;
using testing::Box;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Merged;
using testing::Moved;
using ::testing::Not;
using testing::Sphere;

absl::Status Refusal(const TriangleMesh& mesh, const VoxelizeOptions& options) {
  return Voxelize(mesh, options, {}).status();
}

TEST(VoxelizePoints, MeetsTheWantedNumberWithinTwoPercent) {
  const std::vector<TriangleMesh> meshes = {
      Sphere({0, 0, 0}, 1), testing::Torus(3, 0.5), testing::TrefoilTube(0.2),
      Merged(Sphere({0, 0, 0}, 1), Sphere({40, 0, 0}, 0.5)), Box({0, 0, 0}, {1, 2, 30})};
  for (const TriangleMesh& mesh : meshes) {
    for (uint64_t wanted : {2000u, 30000u, 250000u}) {
      const VoxelizeResult result =
          Voxelized(mesh, {.points = wanted, .topology = TopologyCheck::kSkip});
      const auto count = static_cast<double>(result.volume.PointCount());
      EXPECT_NEAR(count / static_cast<double>(wanted), 1, 0.02);
      EXPECT_THAT(result.warnings, IsEmpty());
    }
  }
}

// A box whose upper face is turned by half a turn: two lobes of opposite orientation.
TriangleMesh BowTie() {
  TriangleMesh mesh = Box({-1, -1, -1}, {1, 1, 1});
  for (auto& v : mesh.vertices) {
    if (v[2] > 0) v = {-v[0], -v[1], v[2]};
  }
  return mesh;
}

TEST(VoxelizePoints, AreMetWhereSignedVolumesCancel) {
  for (const uint64_t wanted : {2000u, 20000u}) {
    const VoxelizeResult result =
        Voxelized(BowTie(), {.points = wanted, .topology = TopologyCheck::kSkip});
    EXPECT_NEAR(static_cast<double>(result.volume.PointCount()) / static_cast<double>(wanted), 1,
                0.02);
  }
}

// Walls of parts that cancel out are not thin: no spacing would resolve them.
TEST(VoxelizeWarnings, AdviseNoSpacingWhereSignedVolumesCancel) {
  const std::array<std::array<double, 2>, 6> outline = {
      {{0, 0}, {1, 1}, {2, 2}, {2, 0}, {1, 1}, {0, 2}}};
  TriangleMesh mesh;
  for (const double z : {0, 1}) {
    for (const auto& [x, y] : outline) mesh.vertices.push_back({x, y, z});
  }
  for (uint32_t n = 0; n < 6; ++n) {
    const uint32_t next = (n + 1) % 6;
    mesh.triangles.push_back({n, next, next + 6});
    mesh.triangles.push_back({n, next + 6, n + 6});
  }
  for (const uint32_t z : {0u, 6u}) {
    mesh.triangles.push_back({z + 1, z + 2, z + 3});
    mesh.triangles.push_back({z + 1, z + 3, z + 4});
    mesh.triangles.push_back({z, z + 1, z + 5});
    mesh.triangles.push_back({z + 1, z + 4, z + 5});
  }
  const std::vector<std::string> warnings = Voxelized(mesh, {.points = 20000}).warnings;
  ASSERT_THAT(warnings, Not(IsEmpty()));
  for (const std::string& warning : warnings) EXPECT_THAT(warning, Not(HasSubstr("--spacing")));
}

// Two tetrahedra with a common edge, one of which a third one crosses.
TEST(VoxelizeWarnings, TellThatTheTopologyIsNotKnownWhereANonManifoldMeshCrossesItself) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},   {0, 0, 3},  {3, 0, 0},   {2, 2, 1},     {-3, 0, 0},
                   {-2, -2, 1}, {1, -1, 1}, {1, 3, 0.6}, {1.6, 3, 0.7}, {1.2, 3, 1.5}};
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}});
  };
  add(0, 1, 2, 3);
  add(0, 1, 4, 5);
  EXPECT_THAT(Voxelized(mesh, {.points = 5000}).warnings, IsEmpty());
  add(6, 7, 8, 9);
  EXPECT_THAT(Voxelized(mesh, {.points = 5000}).warnings,
              Contains(HasSubstr("; the topology of a crossing mesh is not known")));
}

TEST(VoxelizePoints, AreMetWhereEveryFacetIsThereFromBothSides) {
  const TriangleMesh ball = Sphere({0, 0, 0}, 1);
  const VoxelizeResult one = Voxelized(ball, {.points = 2000});
  TriangleMesh twice = ball;
  const TriangleMesh flipped = testing::Flipped(ball);
  twice.triangles.insert(twice.triangles.end(), flipped.triangles.begin(), flipped.triangles.end());
  for (const TriangleMesh& mesh : {twice, testing::Unshared(twice)}) {
    const VoxelizeResult both = Voxelized(mesh, {.points = 2000});
    EXPECT_EQ(both.volume, one.volume);
    EXPECT_THAT(both.warnings, ElementsAre(HasSubstr("from both sides")));
  }
}

// As furniture of CAD programs has it: one facet is missing, another is there twice.
TEST(VoxelizePoints, AreMetWhereTheFacetsOfAnOpenMeshAreThereFromBothSides) {
  TriangleMesh open = Sphere({0, 0, 0}, 1);
  open.triangles.pop_back();
  const VoxelizeResult one = Voxelized(open, {.points = 2000, .fill = FillRule::kWinding});
  TriangleMesh twice = open;
  const TriangleMesh flipped = testing::Flipped(open);
  twice.triangles.insert(twice.triangles.end(), flipped.triangles.begin(), flipped.triangles.end());
  const VoxelizeResult both = Voxelized(twice, {.points = 2000, .fill = FillRule::kWinding});
  EXPECT_EQ(both.volume, one.volume);
  twice.triangles.push_back(open.triangles.front());
  twice.triangles.push_back(flipped.triangles.front());
  EXPECT_TRUE(Voxelize(twice, {.points = 2000}, {}).ok());
}

TEST(VoxelizePoints, SaysSoWhereWholeLayersOfACubeLeaveNoCountNearby) {
  const VoxelizeResult result = Voxelized(Box({0, 0, 0}, {1, 1, 1}), {.points = 40});
  const auto count = static_cast<double>(result.volume.PointCount());
  const bool met = std::abs(count / 40 - 1) <= 0.02;
  if (met) {
    EXPECT_THAT(result.warnings, IsEmpty());
  } else {
    EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("instead of the 40 wanted")));
  }
  EXPECT_GT(count, 10);
  EXPECT_LT(count, 160);
}

// The first grid with layers of points inside has 2 * 10^8 of them.
TEST(VoxelizePoints, AreNotFarMoreThanWantedInAThinPlate) {
  exec::Context context;
  context.deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto plate = Voxelize(Box({0, 0, 0}, {100, 80, 0.001}), {.points = 20000}, context);
  EXPECT_THAT(plate.status().message(), HasSubstr("nothing enclosed"));
  const VoxelizeResult thicker =
      Voxelized(Box({0, 0, 0}, {100, 80, 0.1}), {.points = 1000, .topology = TopologyCheck::kSkip});
  EXPECT_LT(thicker.volume.PointCount(), 512'000u);
}

TEST(VoxelizePoints, OnePointIsAnObjectToo) {
  const VoxelizeResult result = Voxelized(Sphere({0, 0, 0}, 1), {.points = 1});
  EXPECT_GE(result.volume.PointCount(), 1u);
  EXPECT_LE(result.volume.PointCount(), 10u);
}

TEST(VoxelizeSpacing, IsTheEdgeOfTheCubicCellInUnitsOfTheMesh) {
  for (double size : {1e-3, 1.0, 1e6}) {
    const auto result =
        Voxelized(Box({0, 0, 0}, {8 * size, 4 * size, 2 * size}), {.spacing = size / 2});
    EXPECT_EQ(result.volume.PointCount(), 2u * 16 * 8 * 4);
    for (double spacing : result.volume.placement().spacing) EXPECT_NEAR(spacing, size / 2, 1e-9);
  }
}

TEST(VoxelizeSpacing, TooLargeGivesAnEmptySolidWithAWarning) {
  const VoxelizeResult result = Voxelized(Box({0, 0, 0}, {1, 0.01, 0.01}),
                                          {.spacing = 0.9, .thin_parts = ThinParts::kSample});
  EXPECT_TRUE(result.volume.empty());
  EXPECT_THAT(result.warnings, ::testing::Contains(HasSubstr("spacing is too large")));
}

TEST(VoxelizeSpacing, ThatLeavesTooFewPointsIsWarnedOf) {
  const auto warns = HasSubstr("too few for its shape; use a smaller --spacing, or --points");
  const TriangleMesh box = Box({0, 0, 0}, {9, 1, 2});
  EXPECT_THAT(Voxelized(box, {.spacing = 2}).warnings, ::testing::Contains(warns));
  EXPECT_THAT(Voxelized(box, {.spacing = 1}).warnings, ::testing::IsEmpty());
  EXPECT_THAT(Voxelized(box, {.points = 5}).warnings, Not(::testing::Contains(warns)));
}

TEST(VoxelizePlacement, PutsThePointsWhereTheMeshIs) {
  const VoxelizeResult result = Voxelized(Sphere({10, -20, 30}, 2), {.spacing = 0.1});
  WorldPoint sum = {};
  result.volume.ForEachPoint([&](LatticePoint p) {
    const WorldPoint world = result.volume.placement().ToWorld(p);
    EXPECT_LE(std::hypot(world[0] - 10, world[1] + 20, world[2] - 30), 2.0);
    for (size_t axis = 0; axis < 3; ++axis) sum[axis] += world[axis];
  });
  const auto count = static_cast<double>(result.volume.PointCount());
  EXPECT_NEAR(sum[0] / count, 10, 0.01);
  EXPECT_NEAR(sum[1] / count, -20, 0.01);
  EXPECT_NEAR(sum[2] / count, 30, 0.01);
}

TEST(VoxelizePlacement, KeepsItsBitsFarFromTheOrigin) {
  // Multiples of 2^-10 stay exact at an offset of 10^9.
  TriangleMesh mesh = Sphere({0, 0, 0}, 1);
  for (auto& vertex : mesh.vertices) {
    for (double& c : vertex) c = std::ldexp(std::round(std::ldexp(c, 10)), -10);
  }
  const VoxelizeResult here = Voxelized(mesh, {.spacing = 0.0625});
  const VoxelizeResult far = Voxelized(Moved(mesh, 1, {1e9, -1e9, 1e9}), {.spacing = 0.0625});
  EXPECT_EQ(far.volume.SortedPoints(), here.volume.SortedPoints());
  EXPECT_NEAR(far.volume.placement().origin[0] - 1e9, here.volume.placement().origin[0], 1e-6);
  EXPECT_EQ(far.topology, (BettiNumbers{1, 0, 0}));
}

// Twelve rods 200 wide and 1 thick: less than 0.02 % of their box.
TEST(VoxelizeSparse, PaysForTheSolidAndNotForItsBox) {
  TriangleMesh mesh;
  for (double y : {0.0, 199.0}) {
    for (double z : {0.0, 199.0}) {
      mesh = Merged(mesh, Box({0, y, z}, {200, y + 0.5, z + 0.5}));
      mesh = Merged(mesh, Box({y, 0.75, z}, {y + 0.5, 198.75, z + 0.5}));
    }
  }
  const VoxelizeResult result =
      Voxelized(mesh, {.spacing = 0.0625, .topology = TopologyCheck::kSkip});
  const LatticeExtent& extent = result.volume.extent();
  const uint64_t points = result.volume.PointCount();
  EXPECT_LT(static_cast<double>(points), 1e-4 * static_cast<double>(extent.PointCount()));
  EXPECT_GT(points, 700000u);
  EXPECT_LT(result.volume.brick_count() * kBrickPoints, 6 * points);
}

TEST(VoxelizeSparse, AFarSpeckCostsNoMoreThanItself) {
  BCCSKEL_SKIP_WITHOUT_TEST_DATA();
  const auto mesh = ReadMeshFile(testing::TestData("hostile/one_outlier.off"));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  const VoxelizeResult sparse = Voxelized(*mesh, {.spacing = 0.5});
  EXPECT_GT(sparse.volume.extent().nx, 1000000);
  EXPECT_LT(sparse.volume.brick_count(), 20u);
  EXPECT_THAT(Refusal(*mesh, {.points = 100000}).message(), HasSubstr("the limit is 4194304"));
  EXPECT_EQ(Refusal(*mesh, {.points = 100000}).code(), absl::StatusCode::kResourceExhausted);
}

TEST(VoxelizeRefusal, WantsExactlyOneOfPointsAndSpacing) {
  const TriangleMesh mesh = Sphere({0, 0, 0}, 1);
  for (const VoxelizeOptions& options :
       {VoxelizeOptions{}, VoxelizeOptions{.points = 100, .spacing = 0.1}}) {
    EXPECT_EQ(Refusal(mesh, options).code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(Refusal(mesh, options).message(), HasSubstr("exactly one"));
  }
}

TEST(VoxelizeRefusal, NamesTheValueAndTheLimit) {
  const TriangleMesh mesh = Sphere({0, 0, 0}, 1);
  for (double spacing : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(Refusal(mesh, {.spacing = spacing}).code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(Refusal(mesh, {.spacing = spacing}).message(), HasSubstr("finite and positive"));
  }
  const absl::Status none = Refusal(mesh, {.points = 0, .max_points = 500});
  EXPECT_EQ(none.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(none.message(), AllOf(HasSubstr("0 points"), HasSubstr("1 to 500")));
  EXPECT_THAT(Refusal(mesh, {.points = 501, .max_points = 500}).message(), HasSubstr("501"));
}

TEST(VoxelizeRefusal, OfCellsLargerThanTheMesh) {
  const absl::Status status = Refusal(Box({5, 0, 0}, {9, 1, 2}), {.spacing = 10});
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("spacing 10: a cell is larger than the mesh, "
                                          "whose box is 4 x 1 x 2; use a smaller"));
  EXPECT_FALSE(Voxelized(Box({5, 0, 0}, {9, 1, 2}), {.spacing = 4}).volume.empty());
  Voxelized(Box({5, 0, 0}, {9, 1, 2}), {.spacing = 10, .large_cells = LargeCells::kAccept});
}

TEST(VoxelizeRefusal, OfASolidWithTooManyPoints) {
  const absl::Status status = Refusal(Sphere({0, 0, 0}, 1), {.spacing = 0.01, .max_points = 5000});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(status.message(), HasSubstr("5000"));
}

TEST(VoxelizeRefusal, OfAGridWithTooManyCells) {
  const absl::Status status = Refusal(Sphere({0, 0, 0}, 1), {.spacing = 1e-7});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(status.message(), AllOf(HasSubstr("2e+07 cells"), HasSubstr("4194304")));
}

TEST(VoxelizeRefusal, OfMoreCrossingsThanAreServed) {
  const absl::Status status = Refusal(Box({0, 0, 0}, {1, 1, 1}), {.spacing = 1e-5});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(status.message(), HasSubstr("cross"));
}

TEST(VoxelizeRefusal, OfMeshesThatEncloseNothing) {
  const TriangleMesh point = {{{1, 1, 1}}, {{0, 0, 0}}};
  const TriangleMesh plane = Box({0, 0, 0}, {1, 1, 0});
  for (const TriangleMesh& mesh : {point, plane, TriangleMesh{}}) {
    EXPECT_EQ(Refusal(mesh, {.points = 100}).code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(Refusal(mesh, {.points = 100}).message(), HasSubstr("nothing enclosed"));
  }
}

TEST(VoxelizeRefusal, OfSheetsThatAreThereFromBothSides) {
  const TriangleMesh sheet = {{{0, 0, 0}, {1, 0, 0.3}, {0, 1, 0.4}}, {{0, 1, 2}, {0, 2, 1}}};
  const absl::Status status = Refusal(sheet, {.points = 100});
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(status.message(),
              HasSubstr("nothing enclosed: every triangle is there from both sides"));
  EXPECT_THAT(status.message(), HasSubstr("3 boundary edges"));
}

TEST(VoxelizeRefusal, OfSizesThatADoubleCannotHold) {
  const absl::Status status =
      Refusal(Box({-1.7e308, -1.7e308, -1.7e308}, {1.7e308, 1.7e308, 1.7e308}), {.points = 100});
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
}

VoxelizeResult OnTeam(const TriangleMesh& mesh, VoxelizeOptions options, int threads) {
  options.axes = LatticeAxes::kWorld;  // as Voxelized()
  exec::WorkerTeam team(threads);
  exec::Context context;
  context.team = &team;
  auto result = Voxelize(mesh, options, context);
  EXPECT_TRUE(result.ok()) << result.status();
  return *std::move(result);
}

TEST(VoxelizeThreads, GiveTheSameBitsForAnyNumber) {
  TriangleMesh open = testing::Torus(2, 0.8);
  open.triangles.resize(open.triangles.size() - 40);
  const std::vector<std::pair<TriangleMesh, FillRule>> cases = {
      {testing::TrefoilTube(0.3), FillRule::kAuto},
      {Merged(Sphere({0, 0, 0}, 1), Sphere({1, 0, 0}, 1)), FillRule::kParity},
      {open, FillRule::kWinding}};
  for (const auto& [mesh, fill] : cases) {
    const VoxelizeOptions options = {.points = 60000, .fill = fill};
    const VoxelizeResult expected = Voxelized(mesh, options);
    for (int threads : {2, 8}) {
      const VoxelizeResult result = OnTeam(mesh, options, threads);
      EXPECT_EQ(result.volume, expected.volume);
      EXPECT_EQ(result.warnings, expected.warnings);
      EXPECT_EQ(result.topology, expected.topology);
    }
  }
}

TEST(VoxelizeStop, EndsCancelledOrPastItsDeadline) {
  std::stop_source source;
  source.request_stop();
  exec::Context cancelled;
  cancelled.stop = source.get_token();
  exec::Context late;
  late.deadline = exec::Context::Clock::now() - std::chrono::seconds(1);
  const TriangleMesh mesh = Sphere({0, 0, 0}, 1);
  for (const VoxelizeOptions& options :
       {VoxelizeOptions{.points = 1000}, VoxelizeOptions{.spacing = 0.1}}) {
    EXPECT_EQ(Voxelize(mesh, options, cancelled).status().code(), absl::StatusCode::kCancelled);
    EXPECT_EQ(Voxelize(mesh, options, late).status().code(), absl::StatusCode::kDeadlineExceeded);
  }
}

TEST(VoxelizeRefusal, OfCoordinatesThatFloatsHaveMerged) {
  BCCSKEL_SKIP_WITHOUT_TEST_DATA();
  const auto mesh = ReadMeshFile(testing::TestData("hostile/offset_1e9.stl"));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(Refusal(*mesh, {.points = 1000}).code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel
