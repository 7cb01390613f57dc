#include "core/shells/shells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_distance.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

constexpr double kWidths[] = {kMinShellWidth, 1, 1.5, 2, 3.14159, 17, kMaxShellWidth};

TEST(ShellOf, RoundsTheDistanceAsTheReferenceDoes) {
  for (double wanted : kWidths) {
    const double width = std::round(wanted * 209 * 64) / (209 * 64);
    for (uint32_t distance = 1; distance <= 65535; ++distance) {
      ASSERT_EQ(ShellOf(distance, kShortChamfer, width), test::ReferenceShell(distance, width))
          << distance << " at width " << width;
    }
  }
}

TEST(ShellOf, IsAtLeastOne) { EXPECT_EQ(ShellOf(1, kShortChamfer, 64), 1); }

// The register version decides with single precision; what it accepts must be exact.
TEST(FloatShellRule, IsAcceptedOnlyWhereItIsExact) {
  int accepted = 0;
  for (double width : kWidths) {
    const ShellRule exact(static_cast<uint64_t>(std::llround(209 * width * 64)));
    const CheckedFloatRule checked = MakeFloatRule(exact, 65535);
    if (!checked.exact) continue;
    ++accepted;
    alignas(64) uint16_t distances[kBrickPoints];
    for (uint32_t first = 0; first < 65536; first += kBrickPoints) {
      for (uint32_t n = 0; n < kBrickPoints; ++n) distances[n] = static_cast<uint16_t>(first + n);
      ShellPlanes planes;
      SliceBrick(checked.rule, distances, planes);
      for (int n = 0; n < kBrickPoints; ++n) {
        int32_t shell = 0;
        for (size_t b = 0; b < kShellPlanes; ++b) shell |= (planes[b].Test(n) ? 1 : 0) << b;
        ASSERT_EQ(shell, exact(distances[n]) & 63) << distances[n] << " at width " << width;
      }
    }
  }
  EXPECT_GE(accepted, 4);
}

// `shell_at` gives the shell of the point at a bit of a brick.
template <typename ShellAt>
void ExpectShellsAt(const Volume& object, const Shells& shells, const ShellAt& shell_at) {
  int32_t last = 0;
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    Shells::Range range = {INT32_MAX, 0};
    object.bricks()[n].ForEachSetBit([&](int bit) {
      const int32_t shell = shell_at(n, bit);
      range.first = std::min(range.first, shell);
      range.last = std::max(range.last, shell);
      int32_t sliced = 0;
      for (size_t b = 0; b < kShellPlanes; ++b) {
        sliced |= (shells.planes()[n][b].Test(bit) ? 1 : 0) << b;
      }
      ASSERT_EQ(sliced, shell & 63);
    });
    ASSERT_EQ(shells.RangeOf(n).first, range.first);
    ASSERT_EQ(shells.RangeOf(n).last, range.last);
    ASSERT_LT(range.last - range.first, 64) << "modulo 64 would not tell shells apart";
    last = std::max(last, range.last);
  }
  EXPECT_EQ(shells.last(), last);
}

void ExpectShells(const Volume& object, double width) {
  const auto distance = ComputeDistance(object, DistanceKind::kChamfer, exec::Context());
  ASSERT_TRUE(distance.ok());
  const Shells shells = BuildShells(object, *distance, width, exec::Context());
  ExpectShellsAt(object, shells, [&](BrickIndex n, int bit) {
    return ShellOf(distance->At(n, bit), distance->weights(), width);
  });
}

// What a shell is, in long arithmetic.
int32_t ShellOfSquare(double squared, double width) {
  return std::max(1, static_cast<int32_t>(std::floor(std::sqrt(squared) / width + 0.5)));
}

TEST(EuclideanShellRule, IsExactForWholeSquares) {
  for (double width : {0.75, 1.0, 1.5, 2.0, 3.0, 6.0, 17.0, 64.0}) {
    const EuclideanShellRule rule(width);
    for (uint32_t squared = 1; squared < 250'000; ++squared) {
      ASSERT_EQ(rule(static_cast<float>(squared)), ShellOfSquare(squared, width))
          << squared << " at width " << width;
    }
  }
}

void ExpectEuclideanShells(const Volume& object, double wanted) {
  const AxisScale scale = AxisScaleOf(object.placement());
  const double width = EffectiveShellWidth(wanted, scale);
  const auto distance = ComputeDistance(object, DistanceKind::kEuclidean, exec::Context());
  const Shells shells = BuildShells(object, *distance, wanted, exec::Context());
  const EuclideanShellRule rule(width);
  const bool whole =
      std::holds_alternative<exec::UninitializedVector<uint16_t>>(distance->values());
  ExpectShellsAt(object, shells, [&](BrickIndex n, int bit) {
    const uint32_t rank = distance->At(n, bit);
    return rule(whole ? static_cast<float>(rank) : std::bit_cast<float>(rank));
  });
}

void ExpectSameShells(const Volume& object, const Shells& some, const Shells& expected) {
  EXPECT_EQ(some.last(), expected.last());
  ASSERT_EQ(some.brick_count(), expected.brick_count());
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    ASSERT_EQ(some.RangeOf(n).first, expected.RangeOf(n).first);
    ASSERT_EQ(some.RangeOf(n).last, expected.RangeOf(n).last);
    for (size_t b = 0; b < kShellPlanes; ++b) {
      for (size_t k = 0; k < kBrickZ; ++k) {
        const uint64_t different = some.planes()[n][b].words[k] ^ expected.planes()[n][b].words[k];
        ASSERT_EQ(different & object.bricks()[n].words[k], 0u);
      }
    }
  }
}

void ExpectStreamedShells(const Volume& object, DistanceKind kind) {
  const auto distance = ComputeDistance(object, kind, exec::Context());
  const Shells expected = BuildShells(object, *distance, 1, exec::Context());
  constexpr size_t kSlabBySlab = 1;
  for (const size_t at_once : {kMostPointsAtOnce, size_t{40'000}, kSlabBySlab}) {
    for (int threads : {1, 3}) {
      for (double patience : {1e9, -1e9}) {  // never and at once on with one worker
        test::TeamContext context(threads);
        context.patience = patience;
        const auto shells = StreamShells(object, kind, 1, context, at_once);
        ASSERT_TRUE(shells.ok()) << shells.status();
        ExpectSameShells(object, *shells, expected);
      }
    }
  }
}

TEST(StreamedShells, AreThoseOfAllDistancesAtOnce) {
  for (uint64_t seed = 0; seed < 2; ++seed) {
    for (const auto& points : {test::RandomBlob(seed, {60, 50, 50}, 3, 45),
                               test::RandomCloud(seed, {37, 21, 60}, 0.9)}) {
      ExpectStreamedShells(VolumeOfPoints(points), DistanceKind::kChamfer);
      ExpectStreamedShells(VolumeOfPoints(points), DistanceKind::kChamferOptimal);
    }
  }
  ExpectStreamedShells(Volume(), DistanceKind::kChamfer);
}

TEST(StreamedShells, AreExactWhereDistancesNeedMoreThan16Bits) {
  const Volume box = test::FullVolume({1400, 24, 24}, {.spacing = {1, 60, 60}});
  const auto distance = ComputeDistance(box, DistanceKind::kChamfer, exec::Context());
  ASSERT_TRUE(std::holds_alternative<exec::UninitializedVector<uint32_t>>(distance->values()));
  const auto shells = StreamShells(box, DistanceKind::kChamfer, 1, exec::Context());
  ExpectSameShells(box, *shells, BuildShells(box, *distance, 1, exec::Context()));
}

void ExpectStreamedEuclideanShells(const Volume& object, size_t at_once, int threads) {
  const auto distance = ComputeDistance(object, DistanceKind::kEuclidean, exec::Context());
  const BrickDepths depths = BuildDepths(object, *distance, exec::Context());
  test::TeamContext context(threads);
  const auto streamed = StreamEuclideanShells(object, 1, Depths::kWanted, context, at_once);
  ASSERT_TRUE(streamed.ok()) << streamed.status();
  ExpectSameShells(object, streamed->shells, BuildShells(object, *distance, 1, exec::Context()));
  ASSERT_EQ(streamed->depths.size(), depths.size());
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    object.bricks()[n].ForEachSetBit([&](int bit) {
      ASSERT_EQ(streamed->distance->At(n, bit), distance->At(n, bit));
      for (size_t b = 0; b < kDepthPlanes; ++b) {
        ASSERT_EQ(streamed->depths[n][b].Test(bit), depths[n][b].Test(bit));
      }
    });
  }
  EXPECT_EQ(streamed->distance->largest(), distance->largest());
}

TEST(StreamedShells, AreThoseOfEuclideanDistancesHoweverColumnsAreCut) {
  constexpr size_t kColumnByColumn = 1;
  const std::vector<LatticePoint> points = test::RandomBlob(5, {70, 50, 50}, 3, 45);
  for (const auto& spacing : {std::array{1.0, 1.0, 1.0}, std::array{1.0, 1.0, 5.0}}) {
    const Volume object = test::VolumeWith(points, {70, 50, 50}, {.spacing = spacing});
    for (const size_t at_once : {kMostSquaresAtOnce, size_t{40'000}, kColumnByColumn}) {
      ExpectStreamedEuclideanShells(object, at_once, 1);
      ExpectStreamedEuclideanShells(object, at_once, 3);
    }
  }
  ExpectStreamedEuclideanShells(Volume(), kColumnByColumn, 1);
}

TEST(StreamedShells, StopWhenAsked) {
  const exec::Context context = test::Stopped();
  const Volume object = VolumeOfPoints(test::RandomBlob(1, {20, 20, 20}, 3, 9));
  EXPECT_EQ(StreamShells(object, DistanceKind::kChamfer, 1, context, 1).status().code(),
            absl::StatusCode::kCancelled);
}

TEST(Shells, HoldEuclideanShellsForAnySpacingOnEveryInstructionSet) {
  const std::vector<LatticePoint> points = test::RandomBlob(5, {60, 50, 50}, 3, 45);
  for (const std::string& name : exec::SupportedInstructionSets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    for (const auto& spacing :
         {std::array{1.0, 1.0, 1.0}, std::array{1.0, 1.0, 5.0}, std::array{30.0, 1.0, 1.0}}) {
      ExpectEuclideanShells(test::VolumeWith(points, {60, 50, 50}, {.spacing = spacing}), 1);
    }
  }
  exec::ChooseInstructionSet("");
}

TEST(EffectiveShellWidth, IsTheWantedOneForEqualSpacing) {
  EXPECT_EQ(EffectiveShellWidth(kMinShellWidth, kIsotropic), kMinShellWidth);
  EXPECT_GT(EffectiveShellWidth(1, {1, 1, 100}), 10);
}

TEST(Shells, HoldTheShellOfEveryPointOnEveryInstructionSet) {
  const Volume object = VolumeOfPoints(test::RandomBlob(5, {60, 50, 50}, 3, 45));
  for (const std::string& name : exec::SupportedInstructionSets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    for (double width : kWidths) ExpectShells(object, width);
  }
  exec::ChooseInstructionSet("");
}

}  // namespace
}  // namespace bccskel
