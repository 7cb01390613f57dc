#include "core/pipeline/canonical_options.h"

#include <gtest/gtest.h>

#include "core/import/shapes/shapes.h"
#include "core/pruning/sheet_pruner.h"

namespace bccskel {
namespace {

PruningOptions Canonical(const PruningOptions& pruning, const ThinningOptions& thinning) {
  return CanonicalOptions({.thinning = thinning, .pruning = pruning}).pruning;
}

constexpr PruningOptions kNothing = {.rule = PruningRule::kNone, .tips = TipPlacement::kAsThinned};

TEST(CanonicalOptions, NameTheThresholdThatADefaultStandsFor) {
  const ThinningOptions thinning = {.method = ThinningMethod::kSymmetric};
  EXPECT_EQ(Canonical({.rule = PruningRule::kSignificance}, thinning).threshold, 0.47);
  EXPECT_EQ(Canonical({.rule = PruningRule::kRelativeLength}, thinning).threshold, 1);
  EXPECT_EQ(Canonical({.rule = PruningRule::kPersistence}, thinning).threshold, 6);
}

TEST(CanonicalOptions, LeaveWhatWasAskedFor) {
  const PruningOptions given = {.rule = PruningRule::kLength, .threshold = 2.5};
  EXPECT_EQ(Canonical(given, {.method = ThinningMethod::kSymmetric}), given);
}

TEST(CanonicalOptions, NameNoPruningWhereNothingIsPruned) {
  const PruningOptions given = {.rule = PruningRule::kLength, .threshold = 3};
  EXPECT_EQ(Canonical(given, {.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kKernel}),
            kNothing);
  EXPECT_EQ(Canonical(given, {.last_shell = 5}), kNothing);
  EXPECT_EQ(Canonical({.rule = PruningRule::kNone, .threshold = 3}, {}).threshold, 0);
}

TEST(CanonicalOptions, PruneSheetsByTheirThickness) {
  const ThinningOptions surface = {.method = ThinningMethod::kSymmetric,
                                   .kind = SkeletonKind::kSurface};
  EXPECT_EQ(Canonical({}, surface).threshold, kDefaultSheetMargin);
  EXPECT_EQ(Canonical({.threshold = 5}, surface).threshold, 5);
  EXPECT_EQ(Canonical({.rule = PruningRule::kNone}, surface), kNothing);
  for (const PruningRule rule : {PruningRule::kLength, PruningRule::kRelativeLength}) {
    const absl::Status checked =
        CheckSkeletonizeOptions({.thinning = surface, .pruning = {.rule = rule, .threshold = 3}});
    EXPECT_EQ(checked.code(), absl::StatusCode::kInvalidArgument);
  }
}

TEST(CanonicalOptions, MergeJunctionsOfCurvesAlone) {
  const auto reach = [](const ThinningOptions& thinning) {
    return CanonicalOptions({.thinning = thinning, .junction_reach = 2}).junction_reach;
  };
  EXPECT_EQ(reach({}), 2);
  EXPECT_EQ(reach({.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kKernel}), 2);
  EXPECT_EQ(reach({.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kSurface}), 0);
  EXPECT_EQ(reach({.last_shell = 5}), 0);
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
  EXPECT_EQ(pruned->options.pruning.threshold, 0.47);
  const auto surface = Skeletonize(
      ball, {.thinning = {.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kSurface}},
      context);
  ASSERT_TRUE(surface.ok()) << surface.status();
  EXPECT_EQ(surface->options.pruning.threshold, kDefaultSheetMargin);
  EXPECT_EQ(surface->options.pruning.tips, TipPlacement::kAsThinned);
}

}  // namespace
}  // namespace bccskel
