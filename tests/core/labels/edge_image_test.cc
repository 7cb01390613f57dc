#include "core/labels/edge_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <utility>

#include "core/labels/convert_label.h"
#include "core/labels/point_index.h"
#include "core/labels/skeletonize_labels.h"
#include "tests/core/labels/label_volume.h"
#include "tests/support/contexts.h"

namespace bccskel {
namespace {

using test::LabelVolume;
using ::testing::HasSubstr;
using Voxel = std::array<int32_t, 3>;

struct Example {
  LabelVolume volume;
  LabeledObjects collected;
  SkeletonGraph graph;

  const LabeledObject& object() const { return collected.objects[0]; }
};

Example ExampleOf(LabelVolume volume) {
  Example example{std::move(volume), {}, {}};
  example.collected = test::Collected(example.volume);
  const absl::Status status = SkeletonizeLabels(example.collected, {},
                                                [&](LabelSkeleton&& skeleton) {
                                                  example.graph = std::move(skeleton.result.graph);
                                                  return absl::OkStatus();
                                                },
                                                {});
  EXPECT_TRUE(status.ok()) << status;
  return example;
}

// One label: seeded balls that form several components, some with branches.
Example Balls(const Placement& placement, int number = 14, int largest = 6) {
  LabelVolume volume = test::EmptyLabels(60, 40, 30, placement);
  const test::ReferenceMask balls = test::RandomBallMask(8, 60, 40, 30, number, largest);
  for (size_t n = 0; n < balls.voxels.size(); ++n) volume.labels[n] = balls.voxels[n];
  return ExampleOf(std::move(volume));
}

std::map<Voxel, uint32_t> VoxelsOf(const SparseImage& image) {
  std::map<Voxel, uint32_t> voxels;
  for (const auto& [run, value] : image) {
    for (int32_t x = run.begin; x < run.end; ++x) {
      EXPECT_TRUE(voxels.emplace(Voxel{x, run.y, run.z}, value).second);
    }
  }
  return voxels;
}

// Numbers the components of the voxels by flood fill over 26 neighbors. Returns how many there are.
int Flood(std::map<Voxel, int>& components) {
  for (auto& [voxel, component] : components) component = -1;
  int count = 0;
  for (auto& [start, component] : components) {
    if (component >= 0) continue;
    std::vector<Voxel> open = {start};
    component = count;
    while (!open.empty()) {
      const Voxel v = open.back();
      open.pop_back();
      for (int n = 0; n < 27; ++n) {
        const auto near =
            components.find({v[0] + n % 3 - 1, v[1] + n / 3 % 3 - 1, v[2] + n / 9 - 1});
        if (near == components.end() || near->second >= 0) continue;
        near->second = count;
        open.push_back(near->first);
      }
    }
    ++count;
  }
  return count;
}

// Component of each object voxel.
std::map<Voxel, int> ComponentsOf(const LabeledObject& object) {
  std::map<Voxel, int> components;
  for (const VoxelRun& run : object.runs) {
    for (int32_t x = run.begin; x < run.end; ++x) components[{x, run.y, run.z}];
  }
  Flood(components);
  return components;
}

// A place on the grid, in quarters of voxels, with its value: all curve points of the graph.
struct Feature {
  std::array<int32_t, 3> quarters;
  uint32_t value;
};
// Needs: one or two slabs.
std::array<int32_t, 3> QuartersOf(LatticePoint p, const VoxelParts& slabs) {
  return {2 * p.x / slabs[0] - 2, 2 * p.y / slabs[1] - 2, 2 * p.z / slabs[2] - 2};
}
std::vector<Feature> FeaturesOf(const SkeletonGraph& graph, const VoxelParts& slabs) {
  std::vector<Feature> features;
  std::vector<bool> touched(graph.nodes.size());
  const auto add = [&](LatticePoint p, size_t value) {
    features.push_back({QuartersOf(p, slabs), static_cast<uint32_t>(value)});
  };
  for (size_t e = 0; e < graph.edges.size(); ++e) {
    touched[graph.edges[e].source] = touched[graph.edges[e].target] = true;
    for (const SkeletonPoint& p : graph.PointsOf(graph.edges[e])) add(p.point, e + 1);
  }
  for (size_t n = 0; n < graph.nodes.size(); ++n) {
    if (!touched[n]) add(graph.nodes[n].at.point, graph.edges.size() + n + 1);
  }
  return features;
}

// The object voxels that the feature touches.
std::vector<Voxel> VoxelsAt(const Feature& feature, const std::map<Voxel, int>& components) {
  std::vector<Voxel> voxels;
  for (const auto& [v, component] : components) {
    bool touches = true;
    for (size_t a = 0; a < 3; ++a) touches &= std::abs(4 * v[a] - feature.quarters[a]) <= 2;
    if (touches) voxels.push_back(v);
  }
  return voxels;
}

void ExpectNearestEdges(const Example& example, int threads) {
  test::TeamContext context(threads);
  const auto image = NearestEdges(example.volume.grid, example.object(), example.graph,
                                  MaskAdjacency::k26, context);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_TRUE(std::ranges::is_sorted(*image));
  const std::map<Voxel, uint32_t> values = VoxelsOf(*image);
  const std::map<Voxel, int> components = ComponentsOf(example.object());
  EXPECT_EQ(values.size(), components.size());
  std::map<int, std::vector<Feature>> features;
  const VoxelParts slabs = SlabsOf(example.volume.grid, VoxelPoints::kTwo);
  for (const Feature& f : FeaturesOf(example.graph, slabs)) {
    features[components.at(VoxelsAt(f, components).at(0))].push_back(f);
  }
  const auto& spacing = example.volume.grid.placement.spacing;
  for (const auto& [v, value] : values) {
    std::pair<double, uint32_t> best = {1e300, 0};
    for (const Feature& f : features.at(components.at(v))) {
      double sum = 0;
      for (size_t a = 0; a < 3; ++a) {
        const double d = v[a] * spacing[a] - 0.25 * f.quarters[a] * spacing[a];
        sum += d * d;
      }
      best = std::min(best, {sum, f.value});
    }
    ASSERT_EQ(value, best.second) << v[0] << " " << v[1] << " " << v[2];
  }
}

TEST(NearestEdges, AreThoseFoundByLookingAtAllCurvePointsOfTheComponent) {
  const Example example = Balls({}, 40, 5);
  ASSERT_GT(example.graph.edges.size(), 5u);
  ExpectNearestEdges(example, 1);
  ExpectNearestEdges(example, 3);
}

TEST(NearestEdges, FollowTheSpacingOfTheImageAndNotItsPosition) {
  ExpectNearestEdges(Balls({{1, 2, 4}, {0.1, -70.3, 1e3}, {0, -1, 0, 1, 0, 0, 0, 0, 1}}), 1);
}

TEST(NearestEdges, AreNeverOfAnotherComponent) {
  // Two bars side by side: for the outer voxels of the thick one the thin one's curve is nearer.
  LabelVolume volume = test::EmptyLabels(24, 12, 9);
  for (int32_t x = 0; x < 24; ++x) {
    for (int32_t z = 0; z < 9; ++z) {
      for (int32_t y = 0; y < 9; ++y) volume.At(x, y, z) = 1;
    }
    volume.At(x, 10, 4) = 1;
  }
  const Example example = ExampleOf(std::move(volume));
  ASSERT_GE(example.graph.edges.size(), 2u);
  const auto image =
      NearestEdges(example.volume.grid, example.object(), example.graph, MaskAdjacency::k26, {});
  ASSERT_TRUE(image.ok());
  const std::map<Voxel, uint32_t> values = VoxelsOf(*image);
  const uint32_t thin = values.at({12, 10, 4});
  EXPECT_NE(values.at({12, 8, 4}), thin);
  ExpectNearestEdges(example, 1);
}

SkeletonPoint CurvePointAt(int32_t x) {
  SkeletonPoint p;
  p.point = {x, 3, 3};
  return p;
}
SkeletonNode NodeAt(int32_t x) {
  SkeletonNode node;
  node.at = CurvePointAt(x);
  return node;
}
// A graph of these nodes in the place of the example's.
SkeletonGraph GraphOf(const Example& example, std::vector<SkeletonNode> nodes) {
  SkeletonGraph graph;
  graph.placement = example.graph.placement;
  graph.nodes = std::move(nodes);
  return graph;
}

absl::StatusOr<SparseImage> NearestEdgesOf(const Example& example, const SkeletonGraph& graph,
                                           const exec::Context& context = {}) {
  return NearestEdges(example.volume.grid, example.object(), graph, MaskAdjacency::k26, context);
}

TEST(NearestEdges, GiveNodesWithoutEdgesTheNumbersBehindTheEdges) {
  LabelVolume volume = test::EmptyLabels(32, 3, 3);
  volume.At(1, 1, 1) = 1;
  for (int32_t x = 4; x < 30; ++x) volume.At(x, 1, 1) = 1;
  const Example example = ExampleOf(std::move(volume));
  // An edge along the bar, a node alone in the single voxel.
  SkeletonGraph graph = GraphOf(example, {NodeAt(9), NodeAt(59), NodeAt(3)});
  graph.edges = {{0, 1, 0, 26}};
  for (int32_t x = 9; x <= 59; x += 2) graph.points.push_back(CurvePointAt(x));
  for (const auto& image : {NearestEdgesOf(example, graph),
                            DrawSkeleton(example.volume.grid, example.object(), graph)}) {
    ASSERT_TRUE(image.ok());
    EXPECT_THAT(*image,
                ::testing::ElementsAre(ValueRun{{1, 1, 1, 2}, 4}, ValueRun{{1, 1, 4, 30}, 1}));
  }
}

TEST(NearestEdges, LeaveOutComponentsWithoutCurve) {
  LabelVolume volume = test::EmptyLabels(8, 3, 3);
  volume.At(1, 1, 1) = volume.At(5, 1, 1) = 1;
  const Example example = ExampleOf(std::move(volume));
  const auto image = NearestEdgesOf(example, GraphOf(example, {NodeAt(3)}));
  ASSERT_TRUE(image.ok());
  EXPECT_THAT(*image, ::testing::ElementsAre(ValueRun{{1, 1, 1, 2}, 1}));
}

// Lattice point (x, 3, 3) lies at (x - 1) / 2 voxels in the rows through voxel (1, 1, 1).
TEST(DrawSkeleton, PutsAPointBesideTheObjectIntoItsNextVoxelIfThatIsOneAway) {
  LabelVolume volume = test::EmptyLabels(8, 3, 3);
  volume.At(1, 1, 1) = 1;
  const Example example = ExampleOf(std::move(volume));
  const auto drawn = [&example](int32_t x) {
    return *DrawSkeleton(example.volume.grid, example.object(), GraphOf(example, {NodeAt(x)}));
  };
  EXPECT_THAT(drawn(5), ::testing::ElementsAre(ValueRun{{1, 1, 1, 2}, 1}));
  EXPECT_THAT(drawn(7), ::testing::IsEmpty());
}

TEST(NearestEdges, KeepRunsOfARowApart) {
  LabelVolume volume = test::EmptyLabels(6, 4, 3);
  for (int32_t x : {1, 2, 3}) volume.At(x, 1, 1) = 1;
  volume.At(1, 2, 1) = volume.At(3, 2, 1) = 1;
  const Example example = ExampleOf(std::move(volume));
  const auto image = NearestEdgesOf(example, GraphOf(example, {NodeAt(5)}));
  ASSERT_TRUE(image.ok());
  EXPECT_THAT(*image, ::testing::ElementsAre(ValueRun{{1, 1, 1, 4}, 1}, ValueRun{{1, 2, 1, 2}, 1},
                                             ValueRun{{1, 2, 3, 4}, 1}));
}

TEST(NearestEdges, StopWhenCancelled) {
  const Example example = Balls({});
  const exec::Context context = test::Stopped();
  EXPECT_EQ(NearestEdgesOf(example, example.graph, context).status().code(),
            absl::StatusCode::kCancelled);
}

TEST(NearestEdges, RefuseADirectionWithoutInverse) {
  Example example = Balls({});
  example.volume.grid.placement.direction = {1, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THAT(std::string(NearestEdgesOf(example, example.graph).status().message()),
              HasSubstr("no inverse"));
}

TEST(DrawSkeleton, SetsOneObjectVoxelForEachCurvePoint) {
  const Example example = Balls({{1, 1, 3}, {5, 5, 5}, {1, 0, 0, 0, 1, 0, 0, 0, 1}});
  const auto image = DrawSkeleton(example.volume.grid, example.object(), example.graph);
  ASSERT_TRUE(image.ok()) << image.status();
  const std::map<Voxel, int> components = ComponentsOf(example.object());
  std::map<Voxel, uint32_t> expected;
  const VoxelParts slabs = SlabsOf(example.volume.grid, VoxelPoints::kTwo);
  for (const Feature& f : FeaturesOf(example.graph, slabs)) {
    const std::vector<Voxel> voxels = VoxelsAt(f, components);
    ASSERT_FALSE(voxels.empty());
    const Voxel first = *std::ranges::min_element(
        voxels, {}, [](const Voxel& v) { return std::tuple(v[2], v[1], v[0]); });
    const auto [at, fresh] = expected.emplace(first, f.value);
    at->second = std::min(at->second, f.value);
  }
  EXPECT_EQ(VoxelsOf(*image), expected);
}

TEST(DrawSkeleton, KeepsComponentsConnectedBesideNotches) {
  for (const double slice : {1, 3}) {
    LabelVolume volume = test::EmptyLabels(24, 24, 24, {{1, 1, slice}});
    std::mt19937_64 random(3);
    for (auto& label : volume.labels) label = random() % 3 == 0;
    const Example example = ExampleOf(std::move(volume));
    const auto image = DrawSkeleton(example.volume.grid, example.object(), example.graph);
    ASSERT_TRUE(image.ok()) << image.status();
    const std::map<Voxel, uint32_t> drawn = VoxelsOf(*image);
    std::map<Voxel, int> curves(drawn.begin(), drawn.end());
    std::map<Voxel, int> components = ComponentsOf(example.object());
    EXPECT_EQ(Flood(curves), Flood(components));
  }
}

TEST(DrawSkeleton, FindsVoxelsForTheCurvesOfSamplings) {
  LabelVolume volume = test::EmptyLabels(40, 12, 12);
  for (int32_t x = 2; x < 38; ++x) {
    for (int32_t n = 0; n < 25; ++n) volume.At(x, 3 + n / 5, 3 + n % 5) = 1;
  }
  const LabeledObjects collected = test::Collected(volume);
  const LabeledObject& object = collected.objects[0];
  const auto sampled = ConvertLabel(volume.grid, object,
                                    {.sampling = MaskSamplingOptions{.points_per_voxel = 3}}, {});
  ASSERT_TRUE(sampled.ok());
  const auto skeleton = Skeletonize(sampled->volume, {}, {});
  ASSERT_TRUE(skeleton.ok());
  const auto image = DrawSkeleton(volume.grid, object, skeleton->graph);
  ASSERT_TRUE(image.ok());
  EXPECT_GT(VoxelsOf(*image).size(), 25u);
}

TEST(PointIndex, FindsTheNearestPointAndTheSmallestValueOnTies) {
  std::mt19937_64 random(5);
  const auto coordinate = [&] { return static_cast<double>(random() % 12); };
  for (size_t count : {1u, 2u, 9u, 300u}) {
    std::vector<ValuePoint> points;
    for (size_t n = 0; n < count; ++n) {
      points.push_back(
          {{coordinate(), coordinate(), coordinate()}, static_cast<uint32_t>(random() % 50)});
    }
    const PointIndex index(points);
    for (int query = 0; query < 500; ++query) {
      const std::array<double, 3> at = {coordinate(), coordinate(), coordinate()};
      std::pair<double, uint32_t> best = {1e300, 0};
      for (const ValuePoint& p : points) {
        double sum = 0;
        for (size_t a = 0; a < 3; ++a) sum += (p.at[a] - at[a]) * (p.at[a] - at[a]);
        best = std::min(best, {sum, p.value});
      }
      const NearestCurvePoint found = index.Find(at, random() % count);
      EXPECT_EQ(std::pair(found.squared, found.value), best);
    }
  }
}

}  // namespace
}  // namespace bccskel
