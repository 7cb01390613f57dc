#include "core/pipeline/skeletonize.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/exec/instruction_sets.h"
#include "tests/core/pipeline/skeleton_of.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"

namespace bccskel::skeletonize {
namespace {

using test::SkeletonOf;

std::vector<Volume> Objects() {
  std::vector<Volume> objects;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const auto blob = test::RandomBlob(seed, {30, 30, 30}, 8, 10);
    objects.push_back(VolumeOfPoints(blob));
    objects.push_back(VolumeOfPoints(test::WithNoisyBoundary(seed, blob, 0.05)));
    objects.push_back(VolumeOfPoints(
        test::RandomCloud(seed, {20, 20, 20}, 0.4 + 0.15 * static_cast<double>(seed))));
  }
  return objects;
}

TEST(Skeletonize, CertifiesWhatAnIndependentCountFinds) {
  for (const Volume& object : Objects()) {
    const SkeletonizeResult result = SkeletonOf(object, {});
    EXPECT_EQ(result.object_points, object.PointCount());
    EXPECT_EQ(result.certificate.input, test::ReferenceBetti(test::ReferencePointSet(object)));
    EXPECT_EQ(result.certificate.skeleton,
              test::ReferenceBetti(test::ReferencePointSet(result.thin)));
    EXPECT_TRUE(result.certificate.TopologyKept());
    EXPECT_EQ(result.certificate.simple_points_left, 0u);
  }
}

TEST(Skeletonize, GraphStatesTheLoopsAndCavitiesOfTheObject) {
  for (const Volume& object : Objects()) {
    const SkeletonizeResult result = SkeletonOf(object, {});
    const BettiNumbers& input = result.certificate.input;
    auto loops = static_cast<int64_t>(result.graph.edges.size()) -
                 static_cast<int64_t>(result.graph.nodes.size()) + input.components;
    int64_t cavities = 0;
    for (const SkeletonNode& node : result.graph.nodes) {
      loops += node.loops;
      cavities += node.cavities;
    }
    EXPECT_EQ(loops, input.loops);
    EXPECT_EQ(cavities, input.cavities);
  }
}

TEST(Skeletonize, GivesOneDigestForAnyThreadsAndInstructionSet) {
  const std::vector<std::string> names = exec::SupportedInstructionSets();
  for (const Volume& object : Objects()) {
    const SkeletonizeResult expected = SkeletonOf(object, {});
    for (const std::string& name : names) {
      ASSERT_TRUE(exec::ChooseInstructionSet(name));
      for (int threads : {1, name == names.front() ? 8 : 2}) {
        const SkeletonizeResult result = SkeletonOf(object, {}, threads);
        EXPECT_EQ(result.sha256, expected.sha256) << name << ", " << threads << " threads";
        EXPECT_TRUE(result.graph == expected.graph);
        EXPECT_TRUE(result.certificate == expected.certificate);
      }
    }
    exec::ChooseInstructionSet("");
  }
}

TEST(Skeletonize, OfAnEmptyObjectIsAnEmptyGraph) {
  const SkeletonizeResult result = SkeletonOf(Volume(), {});
  EXPECT_TRUE(result.graph.nodes.empty());
  EXPECT_EQ(result.object_points, 0u);
  EXPECT_EQ(result.certificate, Certificate());
  EXPECT_FALSE(result.sha256.empty());
}

TEST(Skeletonize, StopsAtEveryShell) {
  const Volume object = VolumeOfPoints(test::RandomBlob(2, {40, 40, 40}, 6, 16));
  for (int32_t stop_after = 1; stop_after < 12; stop_after += 5) {
    std::stop_source source;
    exec::Context context;
    context.stop = source.get_token();
    context.on_shell = [&](const exec::ShellProgress& p) {
      if (p.shell == stop_after) source.request_stop();
    };
    EXPECT_EQ(Skeletonize(object, {}, context).status().code(), absl::StatusCode::kCancelled);
  }
}

TEST(Skeletonize, PartialThinningKeepsTheTopologyToo) {
  const Volume object = VolumeOfPoints(test::RandomBlob(9, {40, 40, 40}, 6, 16));
  uint64_t points = object.PointCount();
  for (int32_t last : {1, 3, 6}) {
    const SkeletonizeResult result = SkeletonOf(object, {.thinning = {.last_shell = last}});
    EXPECT_TRUE(result.certificate.TopologyKept());
    EXPECT_LE(result.skeleton_points, points);
    points = result.skeleton_points;
  }
  EXPECT_LT(points, object.PointCount() / 2);
}

}  // namespace
}  // namespace bccskel::skeletonize
