// The whole path on meshes of others whose topology is known: see MANIFEST.md beside them.
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "core/import/mesh/mesh_file.h"
#include "core/import/voxelize/voxelize.h"
#include "core/pipeline/skeletonize.h"
#include "tests/core/import/mesh/test_data.h"
#include "tests/core/pipeline/skeleton_of.h"
#include "tests/support/reference_thinner.h"

namespace bccskel::real_meshes {
namespace {

using test::SkeletonOf;

struct RealMesh {
  const char* file;
  BettiNumbers solid;
  const char* reason = "";  // why the grid differs from the mesh, if it does
};

void PrintTo(const RealMesh& mesh, std::ostream* out) { *out << mesh.file; }

const std::vector<RealMesh>& KnownMeshes() {
  static const std::vector<RealMesh> kMeshes = {
      {"aorta-surface.stl", {1, 0, 0}},
      {"armadillo_86k.ply", {1, 0, 0}},
      {"boot.obj.gz", {1, 12, 0}, "gaps below a cell between its laces"},
      {"bunny_hr.obj.gz", {1, 0, 0}},
      {"cactus.off", {1, 0, 0}},
      {"elephant.off", {1, 3, 0}},
      {"fertility.off", {1, 4, 0}},
      {"gmsh_t13.stl", {1, 2, 0}},
      {"hand.off", {1, 0, 0}},
      {"horse.ply", {1, 0, 0}},
      {"knot2.off", {2, 2, 0}},
      {"scorpion.ply", {1, 0, 0}},
      {"spot.obj", {1, 0, 0}},
      {"thingi_1514499.stl.gz", {15, 15, 0}},
      {"turbine.off", {1, 11, 0}},
  };
  return kMeshes;
}

class RealMeshes : public ::testing::TestWithParam<RealMesh> {
 protected:
  void SetUp() override { BCCSKEL_SKIP_WITHOUT_TEST_DATA(); }

  static VoxelizeResult Voxelized(uint64_t points) {
    const auto mesh = ReadMeshFile(testing::TestData(std::string("mesh/") + GetParam().file));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    auto result = Voxelize(*mesh, {.points = points}, {});
    EXPECT_TRUE(result.ok()) << result.status();
    return *std::move(result);
  }

  // That of the mesh, unless the grid is known to differ.
  static BettiNumbers GridTopology(const VoxelizeResult& grid) {
    return *GetParam().reason == '\0' ? GetParam().solid : grid.topology.value();
  }
};

std::string NameOf(const ::testing::TestParamInfo<RealMesh>& info) {
  std::string name = info.param.file;
  name.resize(name.find('.'));
  std::erase_if(name, [](char c) { return c == '-' || c == '_'; });
  return name;
}

// Components and loops as a user of the graph counts them.
BettiNumbers TopologyOf(const SkeletonGraph& graph) {
  std::vector<uint32_t> root(graph.nodes.size());
  for (uint32_t n = 0; n < root.size(); ++n) root[n] = n;
  const auto find = [&](uint32_t n) {
    while (root[n] != n) n = root[n] = root[root[n]];
    return n;
  };
  BettiNumbers betti = {.components = static_cast<int64_t>(graph.nodes.size())};
  for (const SkeletonEdge& edge : graph.edges) {
    const uint32_t a = find(edge.source), b = find(edge.target);
    (a == b ? betti.loops : betti.components) += a == b ? 1 : -1;
    root[a] = b;
  }
  for (const SkeletonNode& node : graph.nodes) {
    betti.loops += node.loops;
    betti.cavities += node.cavities;
  }
  return betti;
}

void ExpectTopology(const SkeletonizeResult& result, const BettiNumbers& expected) {
  EXPECT_EQ(result.certificate.input, expected);
  EXPECT_EQ(result.certificate.skeleton, expected);
  EXPECT_EQ(TopologyOf(result.graph), expected);
  EXPECT_EQ(result.certificate.simple_points_left, 0u);
}

TEST_P(RealMeshes, At100000PointsTheSkeletonHasTheTopologyOfTheMeshOnAnyThreadsAndInstructions) {
  const VoxelizeResult grid = Voxelized(100000);
  EXPECT_EQ(grid.mesh.SolidByWinding(),
            (SolidTopology{GetParam().solid.components, GetParam().solid.loops, 0}));
  EXPECT_EQ(grid.warnings.empty(), *GetParam().reason == '\0') << GetParam().reason;
  EXPECT_NEAR(static_cast<double>(grid.volume.PointCount()), 100000, 2000);
  const SkeletonizeResult one = SkeletonOf(grid.volume, {});
  ExpectTopology(one, GridTopology(grid));
  for (int threads : {2, 8}) {
    EXPECT_EQ(SkeletonOf(grid.volume, {}, threads).sha256, one.sha256) << threads << " threads";
  }
  for (const std::string& name : exec::SupportedInstructionSets()) {
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    EXPECT_EQ(SkeletonOf(grid.volume, {}).sha256, one.sha256) << name;
  }
  exec::ChooseInstructionSet("");
}

TEST_P(RealMeshes, At850000PointsTheSkeletonHasTheTopologyOfTheMesh) {
  const VoxelizeResult grid = Voxelized(850000);
  EXPECT_NEAR(static_cast<double>(grid.volume.PointCount()), 850000, 17000);
  const auto processors = static_cast<int>(std::thread::hardware_concurrency());
  ExpectTopology(SkeletonOf(grid.volume, {}, std::max(processors, 1)), GridTopology(grid));
}

TEST_P(RealMeshes, At40000PointsTheEngineAgreesWithTheSlowReference) {
  const Volume object = Voxelized(40000).volume;
  for (const ThinningMethod method : {ThinningMethod::kDirectional, ThinningMethod::kSymmetric}) {
    const SkeletonizeOptions options = {
        .thinning = {.method = method},
        .distance = DistanceKind::kChamfer,  // as the reference
        .pruning = {.rule = PruningRule::kNone, .tips = TipPlacement::kAsThinned}};
    EXPECT_EQ(SkeletonOf(object, options, 2).thin.SortedPoints(),
              test::ReferenceThin(object, options.thinning));
  }
}

TEST(RealOpenMesh, IsFilledByWindingNumberWithoutHolesOrCavities) {
  BCCSKEL_SKIP_WITHOUT_TEST_DATA();
  const auto mesh = ReadMeshFile(testing::TestData("mesh/aneurysm_open.stl.gz"));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  for (uint64_t points : {100000u, 850000u}) {
    const auto grid = Voxelize(*mesh, {.points = points, .fill = FillRule::kWinding}, {});
    ASSERT_TRUE(grid.ok()) << grid.status();
    ExpectTopology(SkeletonOf(grid->volume, {}), {1, 0, 0});
  }
}

INSTANTIATE_TEST_SUITE_P(All, RealMeshes, ::testing::ValuesIn(KnownMeshes()), NameOf);

}  // namespace
}  // namespace bccskel::real_meshes
