// Which points are inside where parts overlap, nest, repeat or do not close.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/import/mesh/mesh_file.h"
#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/core/import/mesh/test_data.h"
#include "tests/core/import/voxelize/voxelized.h"
#include "tests/core/import/voxelize/winding_reference.h"

namespace bccskel {
namespace {

using test::WithSpacing;
using testing::Box;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::Flipped;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Merged;
using ::testing::Not;
using testing::Sphere;

absl::Status Refusal(const TriangleMesh& mesh, FillRule fill) {
  return Voxelize(mesh, {.spacing = 0.2, .fill = fill}, {}).status();
}

// A sphere whose triangles above the given height are missing.
TriangleMesh CutSphere(double height, int rings = 16) {
  TriangleMesh mesh = Sphere({0, 0, 0}, 1, rings);
  std::erase_if(mesh.triangles, [&](const TriangleMesh::Triangle& t) {
    return mesh.vertices[t[0]][2] + mesh.vertices[t[1]][2] + mesh.vertices[t[2]][2] > 3 * height;
  });
  return mesh;
}

// A tube along x, open at both ends.
TriangleMesh OpenTube(int sides) {
  TriangleMesh mesh;
  for (int n = 0; n < sides; ++n) {
    const double phi = 2 * std::numbers::pi * n / sides;
    for (double x : {-2.0, 2.0}) mesh.vertices.push_back({x, std::cos(phi), std::sin(phi)});
    const auto a = static_cast<uint32_t>(2 * n), b = static_cast<uint32_t>(2 * ((n + 1) % sides));
    mesh.triangles.push_back({a, a + 1, b + 1});
    mesh.triangles.push_back({a, b + 1, b});
  }
  return mesh;
}

TEST(FillRule, AutoTakesWindingWhereTheSurfaceIsOriented) {
  const VoxelizeResult result = WithSpacing(Sphere({0, 0, 0}, 1), 0.2);
  EXPECT_EQ(result.fill, FillRule::kWinding);
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_EQ(result.topology, (BettiNumbers{1, 0, 0}));
}

TEST(FillRule, AutoTakesParityWithAWarningWhereOrientationIsInconsistent) {
  TriangleMesh mesh = Sphere({0, 0, 0}, 1);
  for (size_t t = 0; t < mesh.triangles.size(); t += 2) {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
  const VoxelizeResult result = WithSpacing(mesh, 0.2);
  EXPECT_EQ(result.fill, FillRule::kParity);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("not consistently oriented")));
  EXPECT_EQ(result.volume, WithSpacing(Sphere({0, 0, 0}, 1), 0.2).volume);
  EXPECT_EQ(Refusal(mesh, FillRule::kWinding).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(Refusal(mesh, FillRule::kWinding).message(), HasSubstr("use --fill parity"));
}

TEST(FillRule, WindingJoinsPartsThatOverlapAndParityLeavesAHole) {
  const TriangleMesh mesh = Merged(Sphere({0, 0, 0}, 1), Sphere({1, 0, 0}, 1));
  EXPECT_EQ(WithSpacing(mesh, 0.05).topology, (BettiNumbers{1, 0, 0}));
  const VoxelizeResult parity = WithSpacing(mesh, 0.05, FillRule::kParity);
  EXPECT_LT(parity.volume.PointCount(), WithSpacing(mesh, 0.05).volume.PointCount());
  EXPECT_FALSE(parity.volume.Contains(
      {parity.volume.extent().nx, parity.volume.extent().nx, parity.volume.extent().nx}));
}

TEST(FillRule, APartGivenTwiceCountsOnceByWindingAndVanishesByParity) {
  const TriangleMesh once = Sphere({0, 0, 0}, 1);
  const TriangleMesh twice = Merged(once, once);
  EXPECT_EQ(WithSpacing(twice, 0.2).volume, WithSpacing(once, 0.2).volume);
  EXPECT_TRUE(WithSpacing(twice, 0.2, FillRule::kParity).volume.empty());
}

TEST(FillRule, ANestedShellIsACavityWhenItIsOrientedAgainstTheShellAroundIt) {
  const TriangleMesh outer = Sphere({0, 0, 0}, 1), inner = Sphere({0, 0, 0}, 0.5);
  const VoxelizeResult hollow = WithSpacing(Merged(outer, Flipped(inner)), 0.1);
  EXPECT_EQ(hollow.topology, (BettiNumbers{1, 0, 1}));
  EXPECT_THAT(hollow.warnings, IsEmpty());
  EXPECT_EQ(WithSpacing(Merged(Flipped(outer), inner), 0.1).volume, hollow.volume);
  const VoxelizeResult alike = WithSpacing(Merged(outer, inner), 0.1);
  EXPECT_EQ(alike.volume, WithSpacing(outer, 0.1).volume);
  EXPECT_THAT(alike.warnings, ElementsAre(HasSubstr("parity would make them cavities")));
  const VoxelizeResult parity = WithSpacing(Merged(outer, inner), 0.1, FillRule::kParity);
  EXPECT_EQ(parity.volume, hollow.volume);
  EXPECT_THAT(parity.warnings, ElementsAre(HasSubstr("winding would fill them")));
}

TEST(FillRule, PartsTurnedInwardBesidePartsTurnedOutwardFillAlike) {
  const TriangleMesh left = Sphere({0, 0, 0}, 1), right = Sphere({3, 0, 0}, 1);
  EXPECT_EQ(WithSpacing(Merged(left, Flipped(right)), 0.2).volume,
            WithSpacing(Merged(left, right), 0.2).volume);
}

TEST(FillRule, GenusOfTheMeshIsThatOfTheGridAndDifferencesAreSaid) {
  const VoxelizeResult torus = WithSpacing(testing::Torus(2, 0.7), 0.2);
  EXPECT_EQ(torus.mesh.genus, 1);
  EXPECT_EQ(torus.topology, (BettiNumbers{1, 1, 0}));
  EXPECT_THAT(torus.warnings, IsEmpty());
  const TriangleMesh near = Merged(Box({0, 0, 0}, {4, 4, 4}), Box({4.05, 0, 0}, {8, 4, 4}));
  const VoxelizeResult coarse = WithSpacing(near, 0.5);
  EXPECT_EQ(coarse.topology, (BettiNumbers{1, 0, 0}));
  EXPECT_THAT(coarse.warnings, ElementsAre(HasSubstr(
                                   "the volume has 1 component, 0 loops, 0 cavities, but the mesh "
                                   "has 2 components, 0 loops, 0 cavities: walls or gaps are "
                                   "thinner than a cell, which more points or a smaller spacing")));
}

TEST(FillRule, PartsThatOverlapAreUnited) {
  const TriangleMesh crossed = Merged(Sphere({0, 0, 0}, 1), Sphere({1, 0.1, 0.2}, 1));
  EXPECT_THAT(WithSpacing(crossed, 0.2).warnings,
              ElementsAre("the volume has 1 component, 0 loops, 0 cavities, but the mesh has 2 "
                          "components, 0 loops, 0 cavities: its parts overlap, and the volume is "
                          "their union"));
}

// The spheres share a vertex, so they are one surface, which crosses itself.
TEST(FillRule, ASurfaceThatCrossesItselfGetsAWarningThatSaysWhatHelps) {
  const TriangleMesh left = Sphere({0, 0, 0}, 1);
  TriangleMesh right = Sphere({1, 0.1, 0.2}, 1);
  right.vertices[0] = left.vertices[0];
  const TriangleMesh crossed = Merged(left, right);
  EXPECT_THAT(WithSpacing(crossed, 0.2).warnings,
              ElementsAre(::testing::ContainsRegex("[0-9]+ pairs of triangles cross; repair the "
                                                   "mesh; --denoise 1, which .* may help")));
}

TEST(FillRule, TopologyIsNotCountedWhenNotAskedFor) {
  const VoxelizeResult result =
      test::Voxelized(testing::Torus(2, 0.3), {.spacing = 0.7, .topology = TopologyCheck::kSkip});
  EXPECT_EQ(result.topology, std::nullopt);
  EXPECT_THAT(result.warnings, IsEmpty());
}

TEST(FillRule, AutoFillsSurfacesWithSmallHolesAndSaysSo) {
  const TriangleMesh open = CutSphere(0.9);
  const VoxelizeResult result = WithSpacing(open, 0.1);
  EXPECT_EQ(result.fill, FillRule::kWinding);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_THAT(result.warnings.front(), HasSubstr("not closed (32 boundary edges"));
  EXPECT_THAT(result.warnings.front(), HasSubstr("holes: 4 % of the surface"));
  EXPECT_EQ(result.volume, WithSpacing(open, 0.1, FillRule::kWinding).volume);
}

TEST(FillRule, AutoFillsSmallHolesWhereAFewTrianglesTurnDifferently) {
  const TriangleMesh whole = CutSphere(0.9);
  TriangleMesh open = whole;
  std::swap(open.triangles[0][0], open.triangles[0][1]);
  const VoxelizeResult result = WithSpacing(open, 0.1);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_THAT(result.warnings.front(), HasSubstr("0 non-manifold edges, 3 misoriented edges"));
  const auto points = static_cast<double>(WithSpacing(whole, 0.1).volume.PointCount());
  EXPECT_NEAR(static_cast<double>(result.volume.PointCount()), points, 0.01 * points);
}

TEST(FillRule, AutoRefusesSmallHolesWhereManyTrianglesTurnDifferently) {
  TriangleMesh open = CutSphere(0.9);
  for (size_t t = 0; t < open.triangles.size(); t += 100) {
    std::swap(open.triangles[t][0], open.triangles[t][1]);
  }
  EXPECT_EQ(Refusal(open, FillRule::kAuto).code(), absl::StatusCode::kFailedPrecondition);
}

TEST(FillRule, OpenSurfacesAreRefusedUnlessWindingIsAskedFor) {
  const TriangleMesh open = CutSphere(0.5);
  EXPECT_EQ(Refusal(open, FillRule::kAuto).code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(Refusal(open, FillRule::kAuto).message(), HasSubstr("32 boundary edges"));
  EXPECT_THAT(Refusal(open, FillRule::kAuto).message(), HasSubstr(" % of the surface"));
  EXPECT_EQ(Refusal(open, FillRule::kParity).code(), absl::StatusCode::kInvalidArgument);
  const VoxelizeResult result = WithSpacing(open, 0.1, FillRule::kWinding);
  EXPECT_THAT(result.warnings,
              ElementsAre(HasSubstr("generalized winding number"),
                          HasSubstr("the volume has 1 component, 0 loops, 0 cavities; the topology "
                                    "of an open mesh is not known")));
  EXPECT_EQ(result.topology, (BettiNumbers{1, 0, 0}));
}

TEST(FillRule, ManyTunnelsOfAnOpenMeshComeWithTheOptionThatClosesThem) {
  TriangleMesh parts = CutSphere(0.5);
  const auto hint = Contains(HasSubstr("; --cut-loops 0.3 closes tunnels narrower than three "));
  for (int n = 0; n < 8; ++n) {
    EXPECT_THAT(WithSpacing(parts, 0.1, FillRule::kWinding).warnings, Not(hint)) << n;
    TriangleMesh ring = testing::Torus(0.5, 0.2);
    for (auto& v : ring.vertices) v[0] += 3 + 2 * n;
    parts = Merged(parts, ring);
  }
  EXPECT_THAT(WithSpacing(parts, 0.1, FillRule::kWinding).warnings, hint);
}

// The signed volumes cancel, and the sphere that then faces inward is not filled.
TEST(FillRule, PartsOfAnOpenMeshThatTurnAgainstEachOtherGetAWarning) {
  const TriangleMesh open = CutSphere(0.9);
  const TriangleMesh other = testing::Moved(open, 1, {3, 0, 0});
  const VoxelizeResult against =
      WithSpacing(Merged(open, testing::Flipped(other)), 0.1, FillRule::kWinding);
  EXPECT_EQ(against.topology, (BettiNumbers{1, 0, 0}));
  EXPECT_THAT(against.warnings, Contains(HasSubstr("parts of the mesh turn against each other")));
  const VoxelizeResult alike = WithSpacing(Merged(open, other), 0.1, FillRule::kWinding);
  EXPECT_EQ(alike.topology, (BettiNumbers{2, 0, 0}));
  EXPECT_THAT(alike.warnings, Not(Contains(HasSubstr("against"))));
}

TEST(FillRule, CopiesThatVanishByParityAreTold) {
  const TriangleMesh ball = Sphere({0, 0, 0}, 1);
  const absl::Status status =
      Voxelize(Merged(ball, ball), {.points = 2000, .fill = FillRule::kParity}, {}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("a part that is there twice vanishes"));
}

TEST(FillRule, AGapOfATJunctionIsOpenAndAFlatTriangleInItCloses) {
  TriangleMesh split = Box({0, 0, 0}, {1, 1, 1});
  split.vertices.push_back({0.5, 0, 0});
  split.triangles[4] = {0, 8, 5};
  split.triangles.push_back({8, 1, 5});
  EXPECT_EQ(Refusal(split, FillRule::kParity).code(), absl::StatusCode::kInvalidArgument);
  const Volume box = WithSpacing(Box({0, 0, 0}, {1, 1, 1}), 0.03).volume;
  EXPECT_EQ(WithSpacing(split, 0.03).volume, box);
  split.triangles.push_back({0, 1, 8});
  EXPECT_EQ(WithSpacing(split, 0.03).volume, box);
}

// The value at a point is compared with the sum of all solid angles. Only where it is within the
// error of far caps of 1/2 may a point go either way.
void ExpectGeneralizedWinding(const TriangleMesh& mesh, double spacing) {
  const VoxelizeResult result = test::Voxelized(
      mesh, {.spacing = spacing, .fill = FillRule::kWinding, .thin_parts = ThinParts::kSample});
  uint64_t close = 0;
  const test::Agreement agreement = test::Compare(result.volume, mesh, [&](const WorldPoint& p) {
    const double winding = std::abs(test::SolidAngleWinding(mesh, p));
    close += std::abs(winding - 0.5) < 1e-3 ? 1 : 0;
    return winding > 0.5;
  });
  EXPECT_GT(agreement.inside, 500u);
  EXPECT_LE(agreement.different, close);
  EXPECT_LE(close, agreement.points / 100);
}

TEST(GeneralizedWinding, FillsOpenSurfacesAsTheSumOfSolidAnglesSays) {
  for (double height : {0.9, 0.5, 0.1, -0.4}) ExpectGeneralizedWinding(CutSphere(height), 0.11);
  ExpectGeneralizedWinding(OpenTube(13), 0.17);
  ExpectGeneralizedWinding(Merged(OpenTube(7), Sphere({0, 0, 0}, 0.7, 8)), 0.23);
}

TEST(GeneralizedWinding, DoesNotDependOnWhichWayTheSurfaceTurns) {
  const TriangleMesh open = CutSphere(0.3);
  EXPECT_EQ(WithSpacing(Flipped(open), 0.1, FillRule::kWinding).volume,
            WithSpacing(open, 0.1, FillRule::kWinding).volume);
}

TEST(GeneralizedWinding, LosesOnlyALittleAtOneMissingTriangle) {
  TriangleMesh mesh = Sphere({0, 0, 0}, 1);
  const uint64_t whole = WithSpacing(mesh, 0.05).volume.PointCount();
  mesh.triangles.pop_back();
  const VoxelizeResult result = WithSpacing(mesh, 0.05, FillRule::kWinding);
  EXPECT_NEAR(static_cast<double>(result.volume.PointCount()), static_cast<double>(whole),
              0.002 * static_cast<double>(whole));
  EXPECT_EQ(result.topology, (BettiNumbers{1, 0, 0}));
}

TEST(FillRule, DropsDegenerateTrianglesAndSaysSo) {
  BCCSKEL_SKIP_WITHOUT_TEST_DATA();
  const auto mesh = ReadMeshFile(testing::TestData("hostile/zero_area.off"));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  const VoxelizeResult result = test::Voxelized(*mesh, {.points = 5000});
  EXPECT_EQ(result.topology, (BettiNumbers{1, 0, 0}));
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("degenerate")));
}

struct HostileMesh {
  const char* file;
  BettiNumbers topology;
};

TEST(FillRule, MeshesWithTrapsGiveTheSolidThatTheDocumentedRuleSays) {
  BCCSKEL_SKIP_WITHOUT_TEST_DATA();
  for (const HostileMesh& expected :
       std::vector<HostileMesh>{{"inverted.off", {1, 0, 0}},
                                {"mixed_orientation.off", {1, 0, 0}},
                                {"hollow_sphere.off", {1, 0, 1}},
                                {"hollow_same_orientation.off", {1, 0, 0}},
                                {"matryoshka.off", {2, 0, 1}},
                                {"overlap_two_spheres.off", {1, 0, 0}},
                                {"duplicate_solid.off", {1, 0, 0}},
                                {"offset_1e9.off", {1, 0, 0}},
                                {"huge_1e30.off", {1, 0, 0}},
                                {"tiny_1e-30.off", {1, 0, 0}}}) {
    const auto mesh = ReadMeshFile(testing::TestData(std::string("hostile/") + expected.file));
    ASSERT_TRUE(mesh.ok()) << expected.file << mesh.status();
    const VoxelizeResult result = test::Voxelized(*mesh, {.points = 20000});
    EXPECT_EQ(result.topology, expected.topology) << expected.file;
    EXPECT_NEAR(static_cast<double>(result.volume.PointCount()), 20000, 400) << expected.file;
  }
}

}  // namespace
}  // namespace bccskel
