#include "core/pruning/prune.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/import/shapes/shapes.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"
#include "core/thinning/thinning.h"
#include "tests/core/pruning/simple_noise.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

SkeletonizeOptions WithPruning(PruningOptions pruning, ThinningMethod method) {
  SkeletonizeOptions options;
  options.thinning.method = method;
  options.distance = DistanceKind::kEuclidean;
  options.pruning = pruning;
  return options;
}

size_t EndsOf(const SkeletonGraph& graph) {
  return static_cast<size_t>(std::ranges::count(graph.nodes, NodeKind::kEnd, &SkeletonNode::kind));
}

// The fewest and the most ends that a shape may have.
struct ShapeCase {
  Shape shape;
  size_t fewest;
  size_t most;
};

constexpr std::array kAllNoises = {0.05, 0.0, 0.02, 0.1};
constexpr auto kNoises = std::span(kAllNoises).first(test::kSanitized ? 1 : 4);

class PrunedShapes : public testing::TestWithParam<ShapeCase> {};

TEST_P(PrunedShapes, HaveTheirTrueEndsWithAndWithoutNoise) {
  const auto& [shape, fewest, most] = GetParam();
  const Volume clean = *GenerateShape(shape, {.points = 100'000});
  for (ThinningMethod method : {ThinningMethod::kDirectional, ThinningMethod::kSymmetric}) {
    for (double noise : kNoises) {
      SCOPED_TRACE(noise);
      const Volume object = noise == 0 ? clean : test::WithSimpleNoise(clean, noise, 1);
      const auto result = Skeletonize(object, WithPruning({}, method), {});
      ASSERT_TRUE(result.ok()) << result.status();
      EXPECT_EQ(result->certificate.simple_points_left, 0u);
      EXPECT_GE(EndsOf(result->graph), fewest);
      EXPECT_LE(EndsOf(result->graph), most);
    }
  }
}
// The trees end at their tips and at the foot of the trunk. The horse's ears hardly stand out of
// its head: one may go.
INSTANTIATE_TEST_SUITE_P(
    All, PrunedShapes,
    testing::Values(ShapeCase{Shape::kTorus, 0, 0}, ShapeCase{Shape::kKnot, 0, 0},
                    ShapeCase{Shape::kTubes, 9, 9}, ShapeCase{Shape::kTree, 34, 34},
                    ShapeCase{Shape::kHorse, 7, 8}),
    [](const auto& param) { return std::string(ShapeName(param.param.shape)); });

TEST(Pruning, RemovesWhatNoiseRaises) {
  const Volume object =
      test::WithSimpleNoise(*GenerateShape(Shape::kTree, {.points = 100'000}), 0.1, 1);
  const auto ends_with = [&](PruningOptions pruning) {
    return EndsOf(
        Skeletonize(object, WithPruning(pruning, ThinningMethod::kDirectional), {})->graph);
  };
  const size_t raw = ends_with({PruningRule::kNone, 0, TipPlacement::kAsThinned});
  EXPECT_GT(raw, 50u);
  EXPECT_LT(ends_with({PruningRule::kRelativeLength, 1, TipPlacement::kAsThinned}), raw);
  EXPECT_LT(ends_with({PruningRule::kLength, 3, TipPlacement::kAsThinned}), raw);
  EXPECT_EQ(ends_with({PruningRule::kLength, 1e-3, TipPlacement::kAsThinned}), raw);
  EXPECT_EQ(ends_with({PruningRule::kSignificance, 0, TipPlacement::kAsThinned}), 34u);
}

TEST(Pruning, LeavesKeptPointsAndTheirBranches) {
  const Volume object =
      test::WithSimpleNoise(*GenerateShape(Shape::kTorus, {.points = 50'000}), 0.1, 1);
  SkeletonizeOptions options =
      WithPruning({PruningRule::kNone, 0, TipPlacement::kAsThinned}, ThinningMethod::kDirectional);
  const auto raw = Skeletonize(object, options, {});
  ASSERT_GT(EndsOf(raw->graph), 0u);
  for (const SkeletonNode& node : raw->graph.nodes) {
    if (node.kind == NodeKind::kEnd) options.thinning.keep.push_back(node.at.point);
  }
  options.pruning = {};
  const auto result = Skeletonize(object, options, {});
  for (LatticePoint p : options.thinning.keep) EXPECT_TRUE(result->thin.Contains(p));
}

TEST(Pruning, IsTheSameForAnyThreadCount) {
  const Volume object =
      test::WithSimpleNoise(*GenerateShape(Shape::kHorse, {.points = 50'000}), 0.05, 3);
  SkeletonizeOptions options;
  const auto levels_of = [](const SkeletonGraph& graph) {
    std::vector<double> levels;
    for (const SkeletonEdge& edge : graph.edges) levels.push_back(edge.pruning_level);
    return levels;
  };
  const auto expected = Skeletonize(object, options, {});
  for (int threads : {2, 3}) {
    test::TeamContext context(threads);
    const auto result = Skeletonize(object, options, context);
    EXPECT_EQ(result->sha256, expected->sha256);
    EXPECT_EQ(levels_of(result->graph), levels_of(expected->graph));
  }
}

// Straight tubes through an image, with rough surfaces.
Volume TubesThroughImage(uint64_t seed) {
  constexpr int32_t kEdge = 40;
  constexpr int kTubes = 12;
  constexpr double kRadius = 3;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0, kEdge), way(-1, 1), noise(-0.3, 0.3);
  std::vector<std::array<WorldPoint, 2>> tubes(kTubes);
  for (auto& [from, along] : tubes) {
    from = {place(random), place(random), place(random)};
    along = {way(random), way(random), way(random)};
  }
  absl::StatusOr<MaskConverter> converter = MaskConverter::Create({kEdge, kEdge, kEdge, {}}, {});
  for (int32_t z = 0; z < kEdge; ++z) {
    std::vector<uint64_t> rows(kEdge);
    for (int32_t y = 0; y < kEdge; ++y) {
      for (int32_t x = 0; x < kEdge; ++x) {
        const double radius = kRadius + noise(random);
        const bool inside = std::ranges::any_of(tubes, [&](const auto& tube) {
          const auto& [from, along] = tube;
          const WorldPoint to = {x - from[0], y - from[1], z - from[2]};
          return Dot(to, to) - Dot(to, along) * Dot(to, along) / Dot(along, along) <
                 radius * radius;
        });
        if (inside) rows[static_cast<size_t>(y)] |= uint64_t{1} << x;
      }
    }
    EXPECT_TRUE(converter->AddSlice(rows, {}).ok());
  }
  return std::move(*converter).Finish()->volume;
}

TEST(Pruning, OfLimbsThatTheBorderCutsIsTheSameForAnyThreadCount) {
  SkeletonizeOptions options;
  options.source = ObjectSource::kVoxels;
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const Volume object = TubesThroughImage(seed);
    const auto expected = Skeletonize(object, options, {});
    ASSERT_TRUE(expected.ok()) << expected.status();
    EXPECT_EQ(expected->certificate.skeleton, expected->certificate.input);
    EXPECT_GE(EndsOf(expected->graph), 5u);
    for (int threads : {2, 3}) {
      test::TeamContext context(threads);
      EXPECT_EQ(Skeletonize(object, options, context)->sha256, expected->sha256) << seed;
    }
  }
}

TEST(PruningOptions, AreChecked) {
  EXPECT_TRUE(CheckPruningOptions({}).ok());
  EXPECT_EQ(CheckPruningOptions({PruningRule::kLength, 0}).code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(CheckPruningOptions({PruningRule::kSignificance, -1}).code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(Pruning, OfNothingIsNothing) {
  const Volume nothing;
  const auto field = ComputeDistance(nothing, DistanceKind::kChamfer, {});
  const auto pruned = Prune({}, {nothing, ExactRadius(nothing, *field)}, {}, {}, {});
  ASSERT_TRUE(pruned.ok()) << pruned.status();
  EXPECT_TRUE(pruned->points.empty() && pruned->radii.empty());
}

TEST(Pruning, StopsWhenAsked) {
  const Volume object = VolumeOfPoints(test::RandomBlob(1, {20, 20, 20}, 3, 9));
  const auto field = ComputeDistance(object, DistanceKind::kChamfer, {});
  const Volume thin = ThinObject(object, *field, {}, {})->thin;
  const auto radii = ExactRadii(thin, ExactRadius(object, *field), {});
  const exec::Context context = test::Stopped();
  EXPECT_EQ(
      Prune({thin, *radii}, {object, ExactRadius(object, *field)}, {}, {}, context).status().code(),
      absl::StatusCode::kCancelled);
}

class PruningLaw : public testing::TestWithParam<uint64_t> {};

TEST_P(PruningLaw, KeepsTopologyAndLeavesNothingSimple) {
  const uint64_t seed = GetParam();
  const LatticeExtent extent = {40, 30, 30};
  const auto blob = test::RandomBlob(seed, extent, 8, 14);
  for (const auto& points : {blob, test::WithNoisyBoundary(seed, blob, 0.1),
                             test::RandomCloud(seed, {16, 16, 16}, 0.6)}) {
    const Volume object = VolumeOfPoints(points);
    for (PruningRule rule : {PruningRule::kSignificance, PruningRule::kLength,
                             PruningRule::kRelativeLength, PruningRule::kNone}) {
      for (TipPlacement tips : {TipPlacement::kRidge, TipPlacement::kAsThinned}) {
        for (double threshold : {3.0, 1000.0}) {
          const auto result = Skeletonize(
              object, WithPruning({rule, threshold, tips}, ThinningMethod::kDirectional), {});
          ASSERT_TRUE(result.ok()) << result.status();  // which says that topology was kept
          EXPECT_EQ(result->certificate.simple_points_left, 0u);
          for (LatticePoint p : result->thin.SortedPoints()) ASSERT_TRUE(object.Contains(p));
        }
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, PruningLaw, testing::Range<uint64_t>(0, 4, test::kStride));

std::array<double, 3> Turned(double angle, double x, double y, double z) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double a = c * (x - 40) - s * (y - 40), b = s * (x - 40) + c * (y - 40);
  return {c * a - s * (z - 40), b, s * a + c * (z - 40)};
}

// Where the coordinates of the turned points pass the test.
template <typename IsIn>
Volume TurnedSolid(double angle, IsIn is_in) {
  return test::VolumeWhere({40, 40, 40}, [&](int32_t x, int32_t y, int32_t z) {
    return std::apply(is_in, Turned(angle, x, y, z));
  });
}

TEST(PrunedCompactObject, IsAPointInEveryPose) {
  for (const double angle : {0.0, 0.3, 0.55, 0.8}) {
    const auto of = [&](const auto& is_in, const SkeletonizeOptions& options) {
      return Skeletonize(TurnedSolid(angle, is_in), options, {})->graph;
    };
    const auto cube = [](double x, double y, double z) {
      return std::max({std::abs(x), std::abs(y), std::abs(z)}) <= 20;
    };
    const SkeletonGraph graph = of(cube, {});
    ASSERT_EQ(graph.nodes.size(), 1u) << angle;
    EXPECT_EQ(graph.nodes[0].kind, NodeKind::kIsolated);
    EXPECT_NEAR(graph.nodes[0].at.radius, 20, 1.5);
    const auto spheroid = [](double x, double y, double z) {
      return x * x / 2.25 + y * y + z * z <= 20 * 20;
    };
    EXPECT_EQ(EndsOf(of(spheroid, {})), 2u) << angle;
  }
}

// Of a ball with three such spines all stay.
TEST(PrunedCompactObject, WithOneThinSpineHasItsEndInEveryPose) {
  for (const double angle : {0.0, 0.3, 0.55, 0.8}) {
    const Volume object = TurnedSolid(angle, [](double x, double y, double z) {
      return std::hypot(x + 8, y, z) <= 24 || (x > 0 && x <= 24 && std::hypot(y, z) <= 2);
    });
    const SkeletonGraph graph = Skeletonize(object, {}, {})->graph;
    ASSERT_EQ(EndsOf(graph), 2u) << angle;
    const auto radius = [&](const SkeletonNode& node) { return graph.RadiusOf(node.at); };
    EXPECT_LT(radius(*std::ranges::min_element(graph.nodes, {}, radius)), 5) << angle;
  }
}

// Neither ear sticks out enough, so the limb ends between them, not in one.
TEST(PrunedLimb, EndsInTheMiddleOfAHeadWithTwoEarsInEveryPose) {
  for (const double angle : {0.0, 0.3, 0.55, 0.8}) {
    const Volume object = TurnedSolid(angle, [](double x, double y, double z) {
      return (x > -36 && x < 12 && std::hypot(y, z) <= 7) || std::hypot(x - 12, y, z) <= 14 ||
             std::hypot(x - 20, std::abs(y) - 14, z) <= 6;
    });
    const SkeletonGraph graph = Skeletonize(object, {}, {})->graph;
    ASSERT_EQ(EndsOf(graph), 2u) << angle;
    for (const SkeletonNode& node : graph.nodes) {
      const WorldPoint at = graph.PositionOf(node.at);
      EXPECT_LT(std::abs(Turned(angle, 2 * at[0], 2 * at[1], 2 * at[2])[1]), 3) << angle;
    }
  }
}

TEST(PrunedCompactObject, KeepsAPathWithAPointToKeepOrWithoutPruning) {
  const Volume cube = TurnedSolid(0.55, [](double x, double y, double z) {
    return std::max({std::abs(x), std::abs(y), std::abs(z)}) <= 20;
  });
  SkeletonizeOptions options;
  options.pruning.rule = PruningRule::kNone;
  const SkeletonGraph whole = Skeletonize(cube, options, {})->graph;
  ASSERT_GE(EndsOf(whole), 2u);
  const auto end = std::ranges::find(whole.nodes, NodeKind::kEnd, &SkeletonNode::kind);
  options = {};
  options.thinning.keep = {end->at.point};
  EXPECT_EQ(EndsOf(Skeletonize(cube, options, {})->graph), 2u);
}

}  // namespace
}  // namespace bccskel
