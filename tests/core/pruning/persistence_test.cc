#include "core/pruning/persistence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"
#include "core/pruning/branch_pruner.h"
#include "tests/core/pruning/raw_curves.h"
#include "tests/core/pruning/simple_noise.h"

namespace bccskel {
namespace {

// A straight branch of points born in these passes, the end first, on a junction of three.
struct Twig {
  explicit Twig(const std::vector<int32_t>& births_from_end) {
    const auto size = static_cast<int32_t>(births_from_end.size());
    const LatticePoint junction = {size + 2, size + 2, size + 2};
    VolumeBuilder builder({size + 3, size + 3, size + 3});
    for (LatticePoint offset : {LatticePoint{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}) {
      builder.Add(junction + offset);
    }
    for (int32_t n = 0; n < size; ++n) builder.Add({n + 2, n + 2, n + 2});
    thin = *std::move(builder).Build();
    thin.ForEachPoint([&](LatticePoint p) {
      const bool of_twig = p.x == p.y && p.x == p.z && p != junction;
      births.push_back(of_twig ? births_from_end[static_cast<size_t>(p.x - 2)] : 1);
    });
    radii.assign(births.size(), 1);
  }

  double Persistence() const {
    const ThinSet set({thin, radii, births});
    return PersistenceOf(set, BranchFrom(set, {2, 2, 2}));
  }

  Volume thin;
  std::vector<float> radii;
  std::vector<int32_t> births;
};

TEST(Persistence, OfALimbGrowsByOneAPoint) {
  EXPECT_DOUBLE_EQ(Twig({5}).Persistence(), 1 / 1.25);
  EXPECT_DOUBLE_EQ(Twig({5, 5}).Persistence(), 2 / 1.25);
  EXPECT_DOUBLE_EQ(Twig({5, 5, 5, 5, 5, 5}).Persistence(), 6 / 1.25);
}

TEST(Persistence, OfABumpStaysAtOne) {
  EXPECT_DOUBLE_EQ(Twig({0, 1, 2, 3, 4, 5}).Persistence(), 1);
  EXPECT_DOUBLE_EQ(Twig({0, 2, 4, 6, 8}).Persistence(), 1);
}

TEST(Persistence, OfALimbStaysThatOfTheLimbInsideTheBody) {
  EXPECT_DOUBLE_EQ(Twig({4, 4, 4, 4, 9, 14, 19}).Persistence(), 4 / 1.2);
}

// What the definition says, pass by pass: the end point goes in every pass after its birth.
double PersistenceByFire(const std::vector<int32_t>& births) {
  double most = 0;
  size_t end = 0;
  for (int32_t pass = 0; end < births.size(); ++pass) {
    const int32_t birth = births[end];
    if (birth >= pass) continue;
    most = std::max(most, (pass - birth) / (1 + birth / 20.0));
    ++end;
  }
  return most;
}

TEST(Persistence, IsThatOfAFireThatEatsTheBranchFromItsEnd) {
  std::mt19937 random(7);
  for (int turn = 0; turn < 300; ++turn) {
    std::vector<int32_t> births(1 + random() % 12);
    for (int32_t& birth : births) birth = static_cast<int32_t>(random() % 15);
    ASSERT_DOUBLE_EQ(Twig(births).Persistence(), PersistenceByFire(births)) << turn;
  }
}

SkeletonizeOptions ByPersistence(double threshold) {
  SkeletonizeOptions options;
  options.thinning.kind = SkeletonKind::kIsthmusCurve;
  options.pruning = {PruningRule::kPersistence, threshold, TipPlacement::kAsThinned};
  return options;
}

size_t EndsIn(const SkeletonGraph& graph) {
  const auto is_end = [](const SkeletonNode& node) { return node.kind == NodeKind::kEnd; };
  return static_cast<size_t>(std::ranges::count_if(graph.nodes, is_end));
}

TEST(PruningByPersistence, LeavesTheLimbsOfANoisyTree) {
  const Volume clean = *GenerateShape(Shape::kTree, {.points = 30'000});
  for (double noise : {0.0, 0.05, 0.1}) {
    const Volume object = test::WithSimpleNoise(clean, noise, 3);
    const auto result = Skeletonize(object, ByPersistence(0), {});
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(EndsIn(result->graph), 34u) << noise;
  }
}

TEST(PruningByPersistence, NeedsBirths) {
  SkeletonizeOptions options = ByPersistence(0);
  for (SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kKernel}) {
    options.thinning.kind = kind;
    const absl::Status status = CheckSkeletonizeOptions(options);
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("isthmus-curve"), std::string::npos) << status;
  }
  const test::RawCurves raw(VolumeOfPoints({{{2, 2, 2}, {3, 3, 3}}}), SkeletonKind::kCurve);
  EXPECT_EQ(
      Prune(raw.skeleton, {raw.object, ExactRadius(raw.object, raw.field)}, {}, options.pruning, {})
          .status()
          .code(),
      absl::StatusCode::kInvalidArgument);
}

// One run, all thresholds: what any of them leaves has the topology of the object.
TEST(PruningByPersistence, KeepsTheTopologyAtEveryLevel) {
  for (Shape shape : {Shape::kTorus, Shape::kHollowBall, Shape::kHorse}) {
    const Volume object = test::WithSimpleNoise(*GenerateShape(shape, {.points = 20'000}), 0.1, 5);
    for (double threshold : {1e-6, 0.5, 1.0, 2.0, 8.0, 1e9}) {
      const auto result = Skeletonize(object, ByPersistence(threshold), {});
      ASSERT_TRUE(result.ok()) << result.status();  // which says that topology was kept
      EXPECT_EQ(result->certificate.simple_points_left, 0u);
    }
  }
}

TEST(Births, AreAboutTheRadiusOfALimb) {
  const Volume object = *GenerateShape(Shape::kTorus, {.points = 30'000});
  const auto result = Skeletonize(object, ByPersistence(0), {});
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->graph.edges.size(), 1u);
  EXPECT_TRUE(result->graph.HasBirths());
  for (const SkeletonPoint& p : result->graph.points) EXPECT_NEAR(p.birth, p.radius, 3);
}

TEST(Births, AreThoseOfThinningForNodesAndPoints) {
  const test::RawCurves raw(*GenerateShape(Shape::kTree, {.points = 20'000}),
                            SkeletonKind::kIsthmusCurve);
  const auto result = Skeletonize(raw.object, ByPersistence(0), {});
  const ThinSet set(raw.skeleton);
  for (const SkeletonPoint& p : result->graph.points) EXPECT_EQ(p.birth, set.BirthOf(p.point));
  for (const SkeletonNode& n : result->graph.nodes) EXPECT_EQ(n.at.birth, set.BirthOf(n.at.point));
}

TEST(Births, AreNoneOfOtherKinds) {
  const Volume object = *GenerateShape(Shape::kTree, {.points = 20'000});
  EXPECT_FALSE(Skeletonize(object, {}, {})->graph.HasBirths());
}

}  // namespace
}  // namespace bccskel
