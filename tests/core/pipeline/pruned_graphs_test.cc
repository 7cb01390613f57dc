#include "core/pipeline/pruned_graphs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {
namespace {

using Counts = std::map<NodeKind, int>;

struct Step {
  double level;
  Counts kinds;
  size_t edges;
};

Counts KindsOf(const SkeletonGraph& graph) {
  Counts counts;
  for (const SkeletonNode& node : graph.nodes) ++counts[node.kind];
  return counts;
}

// Ends as thinned: another run may move those it leaves elsewhere, and the widths of limbs with
// them.
SkeletonizeOptions Pruned(PruningOptions pruning, ObjectSource source) {
  SkeletonizeOptions options;
  options.pruning = pruning;
  options.pruning.tips = TipPlacement::kAsThinned;
  options.source = source;
  return options;
}

std::vector<Step> StepsOf(const SkeletonGraph& graph, uint64_t most_points) {
  std::vector<Step> steps;
  EXPECT_TRUE(ForEachPrunedGraph(graph, kDefaultJunctionReach, most_points, {},
                                 [&](double level, const SkeletonGraph& pruned) {
                                   steps.push_back({level, KindsOf(pruned), pruned.edges.size()});
                                 })
                  .ok());
  return steps;
}

constexpr uint64_t kUnlimited = std::numeric_limits<uint64_t>::max();

struct Case {
  Shape shape;
  double noise;
  ObjectSource source;
};
class PrunedGraphs : public testing::TestWithParam<Case> {};

TEST_P(PrunedGraphs, AreThoseOfRunsWithThatThreshold) {
  const auto& [shape, noise, source] = GetParam();
  const Volume object = *GenerateShape(shape, {.points = 30'000, .noise = noise});
  const auto whole = Skeletonize(object, Pruned({.rule = PruningRule::kNone}, source), {});
  ASSERT_TRUE(whole.ok()) << whole.status();
  const std::vector<Step> steps = StepsOf(whole->graph, kUnlimited);
  ASSERT_FALSE(steps.empty());
  for (size_t n = 0; n < steps.size(); n += 1 + steps.size() / 12) {
    const double next = n + 1 < steps.size() ? steps[n + 1].level : steps[n].level + 1;
    const double threshold = (steps[n].level + next) / 2;
    const auto run = Skeletonize(object, Pruned({.threshold = threshold}, source), {});
    ASSERT_TRUE(run.ok()) << run.status();
    EXPECT_EQ(steps[n].kinds, KindsOf(run->graph)) << threshold;
    EXPECT_EQ(steps[n].edges, run->graph.edges.size()) << threshold;
  }
}
INSTANTIATE_TEST_SUITE_P(All, PrunedGraphs,
                         testing::Values(Case{Shape::kTree, 0, ObjectSource::kPoints},
                                         Case{Shape::kTree, 0.1, ObjectSource::kPoints},
                                         Case{Shape::kTubes, 0.1, ObjectSource::kPoints},
                                         Case{Shape::kHorse, 0.05, ObjectSource::kPoints},
                                         Case{Shape::kBlob, 0.1, ObjectSource::kPoints}));

TEST(PrunedGraphsTest, VisitFewerLevelsWhereTracingAllWouldTakeLong) {
  const Volume object = *GenerateShape(Shape::kTree, {.points = 30'000, .noise = 0.1});
  const auto whole =
      Skeletonize(object, Pruned({.rule = PruningRule::kNone}, ObjectSource::kPoints), {});
  ASSERT_TRUE(whole.ok()) << whole.status();
  const std::vector<Step> all = StepsOf(whole->graph, kUnlimited);
  const std::vector<Step> few = StepsOf(whole->graph, 0);
  ASSERT_GT(all.size(), 20u);
  ASSERT_EQ(few.size(), 20u);
  for (size_t n = 1; n <= 10; ++n) EXPECT_EQ(few[20 - n].level, all[all.size() - n].level);
  for (const Step& step : few) {
    const auto same = std::ranges::find(all, step.level, &Step::level);
    ASSERT_NE(same, all.end());
    EXPECT_EQ(step.edges, same->edges);
  }
}

TEST(PrunedGraphsTest, AreNoneWithoutLevels) {
  EXPECT_TRUE(StepsOf(SkeletonGraph(), kUnlimited).empty());
}

}  // namespace
}  // namespace bccskel
