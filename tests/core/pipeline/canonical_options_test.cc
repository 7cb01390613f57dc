#include "core/pipeline/canonical_options.h"

#include <gtest/gtest.h>

#include "core/shapes/shapes.h"

namespace bccskel {
namespace {

PruningOptions Canonical(const PruningOptions& pruning, const ThinningOptions& thinning) {
  return CanonicalOptions({.thinning = thinning, .pruning = pruning}).pruning;
}

constexpr PruningOptions kNothing = {.rule = PruningRule::kNone, .tips = TipPlacement::kAsThinned};

TEST(CanonicalOptions, NameTheThresholdThatADefaultStandsFor) {
  const ThinningOptions thinning = {.method = ThinningMethod::kSymmetric};
  EXPECT_EQ(Canonical({.rule = PruningRule::kSlope}, thinning).threshold, 4);
  EXPECT_EQ(Canonical({.rule = PruningRule::kRelativeLength}, thinning).threshold, 1);
  EXPECT_EQ(Canonical({.rule = PruningRule::kPersistence}, thinning).threshold, 6);
  EXPECT_EQ(Canonical(ForSteps({}, 4), thinning).threshold, 16);
}

TEST(CanonicalOptions, LeaveWhatWasAskedFor) {
  const PruningOptions given = {.rule = PruningRule::kLength, .threshold = 2.5};
  EXPECT_EQ(Canonical(given, {.method = ThinningMethod::kSymmetric}), given);
}

TEST(CanonicalOptions, NameNoPruningWhereNothingIsPruned) {
  const PruningOptions given = {.rule = PruningRule::kLength, .threshold = 3};
  for (const SkeletonKind kind : {SkeletonKind::kSurface, SkeletonKind::kKernel}) {
    EXPECT_EQ(Canonical(given, {.method = ThinningMethod::kSymmetric, .kind = kind}), kNothing);
  }
  EXPECT_EQ(Canonical(given, {.last_shell = 5}), kNothing);
  EXPECT_EQ(Canonical({.rule = PruningRule::kNone, .threshold = 3}, {}).threshold, 0);
}

TEST(CanonicalOptions, DoNotChangeTwice) {
  const SkeletonizeOptions once = CanonicalOptions({.thinning = {.last_shell = 2}});
  EXPECT_EQ(CanonicalOptions(once).pruning, once.pruning);
}

TEST(CanonicalOptions, AreThoseOfAResult) {
  const Volume ball = *GenerateShape(Shape::kBall, {.points = kMinShapePoints});
  const exec::Context context;
  const auto pruned = Skeletonize(ball, {}, context);
  ASSERT_TRUE(pruned.ok()) << pruned.status();
  EXPECT_EQ(pruned->options.pruning.threshold, 4);
  const auto surface = Skeletonize(
      ball, {.thinning = {.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kSurface}},
      context);
  ASSERT_TRUE(surface.ok()) << surface.status();
  EXPECT_EQ(surface->options.pruning, kNothing);
}

}  // namespace
}  // namespace bccskel
