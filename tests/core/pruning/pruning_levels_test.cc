#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"
#include "core/pruning/branch_pruner.h"
#include "tests/core/pruning/raw_curves.h"
#include "tests/core/pruning/simple_noise.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using test::LevelsOf;
using test::RawCurves;

// Curves and the rule that their levels are of.
struct RuledCurves {
  RawCurves raw;
  PruningRule rule;
};

std::vector<RuledCurves> Objects() {
  std::vector<RuledCurves> objects;
  const auto add = [&](const Volume& object) {
    objects.push_back({RawCurves(object, SkeletonKind::kCurve), PruningRule::kSignificance});
    objects.push_back({RawCurves(object, SkeletonKind::kIsthmusCurve), PruningRule::kPersistence});
  };
  for (Shape shape : {Shape::kTree, Shape::kHorse, Shape::kKnot, Shape::kHollowBall}) {
    const Volume clean = *GenerateShape(shape, {.points = 15'000});
    add(clean);
    add(test::WithSimpleNoise(clean, 0.1, 7));
  }
  for (uint64_t seed : {1U, 2U, 3U}) {
    add(VolumeOfPoints(test::RandomCloud(seed, {20, 20, 20}, 0.6)));
  }
  return objects;
}

// Thresholds at, just below and just above levels of the object, and between.
std::vector<double> ThresholdsFor(const PruningLevels& levels) {
  std::vector<double> all = {0.25, 1, 4, 1000};
  levels.ForEach([&](LatticePoint, double level) {
    if (std::isfinite(level) && level > 0) all.push_back(level);
  });
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<double> some;
  for (size_t n = 0; n < all.size(); n += 1 + all.size() / 8) {
    some.insert(some.end(), {std::nextafter(all[n], 0), all[n], std::nextafter(all[n], 1e9)});
  }
  return some;
}

TEST(PruningLevels, TellWhatEveryThresholdLeaves) {
  size_t kept = 0, gone = 0;
  for (const auto& [raw, rule] : Objects()) {
    const PruningLevels levels = LevelsOf(raw.PrunedBy(PruningRule::kNone, 0));
    for (double threshold : ThresholdsFor(levels)) {
      SCOPED_TRACE(threshold);
      const Volume pruned = raw.PrunedBy(rule, threshold).points;
      levels.ForEach([&](LatticePoint p, double level) {
        ASSERT_EQ(pruned.Contains(p), level >= threshold);
        ++(level >= threshold ? kept : gone);
      });
    }
  }
  EXPECT_GT(kept, 0u);
  EXPECT_GT(gone, 0u);
}

TEST(PruningLevels, OfAPrunedSkeletonAreThoseOfItsBranchesBefore) {
  for (const auto& [raw, rule] : Objects()) {
    const PruningLevels before = LevelsOf(raw.PrunedBy(PruningRule::kNone, 0));
    LevelsOf(raw.PrunedBy(rule, 3)).ForEach([&](LatticePoint p, double level) {
      EXPECT_GE(level, 3);
      const double* found = before.Find(p);
      if (found == nullptr) return;  // a branch point now, a junction before
      EXPECT_EQ(*found, level);
    });
  }
}

TEST(PruningLevels, LeaveLoopsAndOnePathOfEveryTreeForever) {
  for (Shape shape : {Shape::kTorus, Shape::kKnot, Shape::kTree}) {
    const Volume object = test::WithSimpleNoise(*GenerateShape(shape, {.points = 15'000}), 0.1, 7);
    for (const auto& [kind, rule] : {std::pair(SkeletonKind::kCurve, PruningRule::kSignificance),
                                     {SkeletonKind::kIsthmusCurve, PruningRule::kPersistence}}) {
      const ThinSkeleton pruned = RawCurves(object, kind).PrunedBy(rule, 1e9);
      EXPECT_FALSE(LevelsOf(pruned).empty());
      LevelsOf(pruned).ForEach([](LatticePoint, double level) { EXPECT_EQ(level, HUGE_VAL); });
      EXPECT_EQ(*CountBettiNumbers(pruned.points, {}), *CountBettiNumbers(object, {}));
    }
  }
}

TEST(PruningLevels, OfBranchesWithKeptPointsAreInfinite) {
  const RawCurves raw(*GenerateShape(Shape::kTree, {.points = 15'000}), SkeletonKind::kCurve);
  const std::vector<LatticePoint> ends = ThinSet(raw.skeleton).Ends();
  const PointSet keep(ends.begin(), ends.end());
  Significance significance(raw.object, {.thin = 1, .thick = 1});
  PruningLevelsOf(ThinSet(raw.skeleton), significance, PruningRule::kSignificance, keep, {})
      .ForEach([](LatticePoint, double level) { EXPECT_EQ(level, HUGE_VAL); });
}

}  // namespace
}  // namespace bccskel
