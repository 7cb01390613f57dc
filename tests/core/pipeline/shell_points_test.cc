#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using PointsByShell = std::vector<std::pair<int32_t, std::vector<LatticePoint>>>;

struct Peeled {
  SkeletonizeResult result;
  PointsByShell shells;
};

Peeled Peel(const Volume& object, const SkeletonizeOptions& options, int threads = 1) {
  test::TeamContext context(threads);
  Peeled peeled;
  peeled.result = *Skeletonize(object, options, context, [&](int32_t shell, Volume points) {
    peeled.shells.emplace_back(shell, points.SortedPoints());
  });
  return peeled;
}

std::vector<Volume> PeeledObjects() {
  std::vector<Volume> objects = {*GenerateShape(Shape::kTree, {.points = 20'000, .noise = 0.05}),
                                 *GenerateShape(Shape::kHollowBall, {.points = 10'000})};
  for (uint64_t seed : {1U, 2U}) {
    objects.push_back(VolumeOfPoints(test::RandomBlob(seed, {40, 30, 30}, 8, 14)));
    objects.push_back(VolumeOfPoints(test::RandomCloud(seed, {20, 20, 20}, 0.6)));
  }
  return objects;
}

SkeletonizeOptions With(ThinningMethod method, TipPlacement tips) {
  SkeletonizeOptions options;
  options.thinning.method = method;
  options.pruning.tips = tips;
  return options;
}

TEST(ShellPoints, WithTheSkeletonAreTheObjectEachPointOnce) {
  for (const Volume& object : PeeledObjects()) {
    for (ThinningMethod method : {ThinningMethod::kDirectional, ThinningMethod::kSymmetric}) {
      const Peeled peeled = Peel(object, With(method, TipPlacement::kAsThinned));
      std::vector<LatticePoint> all = peeled.result.thin.SortedPoints();
      for (const auto& [shell, points] : peeled.shells) {
        all.insert(all.end(), points.begin(), points.end());
      }
      std::ranges::sort(all);
      EXPECT_EQ(all, object.SortedPoints());
    }
  }
}

TEST(ShellPoints, ComeBackOnlyAtTips) {
  for (const Volume& object : PeeledObjects()) {
    const Peeled peeled = Peel(object, With(ThinningMethod::kSymmetric, TipPlacement::kRidge));
    std::set<LatticePoint> all;
    for (const auto& [shell, points] : peeled.shells) all.insert(points.begin(), points.end());
    const uint64_t gone = all.size();
    for (LatticePoint p : peeled.result.thin.SortedPoints()) all.insert(p);
    EXPECT_EQ(all.size(), object.PointCount());
    EXPECT_LE(gone + peeled.result.skeleton_points, object.PointCount() * 11 / 10);
  }
}

TEST(ShellPoints, ComeShellByShellAndThenWhatPruningTakes) {
  const Volume object = *GenerateShape(Shape::kTree, {.points = 20'000, .noise = 0.05});
  const Peeled peeled = Peel(object, With(ThinningMethod::kDirectional, TipPlacement::kRidge));
  const int32_t last = peeled.result.last_shell;
  ASSERT_GE(peeled.shells.size(), static_cast<size_t>(last) + 1);
  for (size_t n = 0; n < peeled.shells.size(); ++n) {
    EXPECT_EQ(peeled.shells[n].first, std::min(static_cast<int32_t>(n) + 1, last + 1));
  }
}

TEST(ShellPoints, AreTheSameForAnyThreadCountAndChangeNoResult) {
  for (const Volume& object : PeeledObjects()) {
    const SkeletonizeOptions options = With(ThinningMethod::kSymmetric, TipPlacement::kRidge);
    const Peeled expected = Peel(object, options);
    EXPECT_EQ(expected.result.sha256, Skeletonize(object, options, {})->sha256);
    for (int threads : {2, 3}) EXPECT_EQ(Peel(object, options, threads).shells, expected.shells);
  }
}

}  // namespace
}  // namespace bccskel
