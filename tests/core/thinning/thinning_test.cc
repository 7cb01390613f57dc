#include "core/thinning/thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "core/shells/shells.h"
#include "core/thinning/thinning_state.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

namespace bccskel::all_rules {
namespace {

ThinningResult Thin(const Volume& object, const ThinningOptions& options,
                    const exec::Context& context = {}) {
  auto result =
      ThinObject(object, *ComputeDistance(object, DistanceKind::kChamfer, {}), options, context);
  EXPECT_TRUE(result.ok()) << result.status();
  return *std::move(result);
}

Volume Blob(uint64_t seed) { return VolumeOfPoints(test::RandomBlob(seed, {40, 40, 40}, 7, 16)); }

TEST(Thinning, GivesTheSameBitsOnEveryInstructionSetAndNumberOfThreads) {
  const Volume object = Blob(11);
  const Volume expected = Thin(object, {}).thin;
  for (const std::string& name : exec::SupportedInstructionSets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    for (int threads : {1, 2, 5, 8}) {
      test::TeamContext context(threads);
      EXPECT_TRUE(Thin(object, {}, context).thin == expected) << threads << " threads";
    }
  }
  exec::ChooseInstructionSet("");
}

// Gives the bits of one worker with teams of these sizes; the first alone where sanitizers are
// slow.
void ExpectTheBitsOfOneWorker(const Volume& object, std::initializer_list<int> teams) {
  const auto distance = ComputeDistance(object, DistanceKind::kEuclidean, {});
  for (const ThinningMethod method : {ThinningMethod::kDirectional, ThinningMethod::kSymmetric}) {
    const auto alone = ThinObject(object, *distance, {.method = method}, {});
    for (int threads : teams) {
      if (test::kSanitized && threads != *teams.begin()) continue;
      test::TeamContext context(threads);
      context.patience = 1e9;
      const auto shared = ThinObject(object, *distance, {.method = method}, context);
      EXPECT_TRUE(shared->thin == alone->thin) << threads << " threads";
      EXPECT_EQ(shared->removed, alone->removed) << threads << " threads";
      EXPECT_EQ(shared->passes, alone->passes) << threads << " threads";
    }
  }
}

// So tall that workers have bricks far from others', which they look at while others wait for the
// bricks near them.
TEST(Thinning, GivesTheSameBitsForAnyNumberOfThreadsOfATallObject) {
  ExpectTheBitsOfOneWorker(VolumeOfPoints(test::RandomBlob(13, {60, 60, 280}, 8, 90)),
                           {4, 2, 3, 7, 16});
}

// A thick end and a thin stalk, whose bricks have no deep shells, so that ranges of bricks move.
Volume Lollipop() {
  constexpr int32_t kRadius = test::kSanitized ? 90 : 120;
  return test::VolumeWhere({kRadius, kRadius, 6 * kRadius}, [](int32_t x, int32_t y, int32_t z) {
    const int32_t from_axis = (x - kRadius) * (x - kRadius) + (y - kRadius) * (y - kRadius);
    const int32_t up = z - kRadius;
    constexpr int32_t kStalk = kRadius / 5;
    return from_axis <= std::max(kStalk * kStalk, (kRadius - 2) * (kRadius - 2) - up * up);
  });
}

TEST(Thinning, GivesTheSameBitsWhenWorkersShareBricksAnew) {
  ExpectTheBitsOfOneWorker(Lollipop(), {5, 2, 9});
}

TEST(Thinning, GivesTheSameBitsWhenATeamShrinksToOneWorker) {
  const Volume object = Blob(12);
  constexpr double kNever = 1e9, kAtOnce = -1e9;
  for (const double patience : {kNever, kAtOnce}) {
    for (int threads : {2, 3, 8}) {
      for (int32_t last_shell : {1, 2, 0}) {
        test::TeamContext context(threads);  // another one each time: no confidence afterwards
        context.patience = patience;
        const Volume alone = Thin(object, {.last_shell = last_shell}).thin;
        EXPECT_TRUE(Thin(object, {.last_shell = last_shell}, context).thin == alone)
            << threads << " threads, patience " << patience << ", last shell " << last_shell;
      }
    }
  }
}

// The team asks for its share after each cycle, until worker 0 goes on alone. On a busy machine it
// may be alone from the start: then another team tries.
TEST(Thinning, LeavesThreadsToOthersBetweenShellsAndGivesTheSameBits) {
  const Volume object = Blob(12);
  std::vector<uint64_t> points_alone;
  exec::Context one;
  one.on_shell = [&](const exec::ShellProgress& p) { points_alone.push_back(p.points); };
  const Volume alone = Thin(object, {}, one).thin;
  int asked_together = 0;
  for (int tries = 0; tries < 50 && asked_together == 0; ++tries) {
    test::TeamContext context(2);
    context.patience = 1e9;
    int shells = 0, asked_alone = 0;
    std::vector<uint64_t> points;
    context.on_shell = [&](const exec::ShellProgress& p) {
      points.push_back(p.points);
      ++shells;
    };
    context.share = [&] {
      if (shells > 0) ++(shells > 3 ? asked_alone : asked_together);
      return shells >= 2 ? 1 : 2;
    };
    EXPECT_TRUE(Thin(object, {}, context).thin == alone);
    EXPECT_EQ(points, points_alone);
    EXPECT_GT(shells, 4);
    EXPECT_EQ(asked_alone, 0);
  }
  EXPECT_GT(asked_together, 0);
}

TEST(Thinning, ReportsEveryShellOnce) {
  const Volume object = Blob(3);
  std::vector<exec::ShellProgress> reports;
  exec::Context context;
  context.on_shell = [&](const exec::ShellProgress& p) { reports.push_back(p); };
  const ThinningResult result = Thin(object, {}, context);
  ASSERT_EQ(reports.size(), static_cast<size_t>(result.last_shell));
  uint64_t opened = 0;
  for (size_t n = 0; n < reports.size(); ++n) {
    EXPECT_EQ(reports[n].shell, static_cast<int32_t>(n) + 1);
    EXPECT_EQ(reports[n].last_shell, result.last_shell);
    EXPECT_EQ(reports[n].removed + reports[n].remaining, object.PointCount());
    opened += reports[n].points;
  }
  EXPECT_LE(opened,
            object.PointCount());  // points removed as stubble before their shell opens: none
  EXPECT_EQ(reports.back().removed, result.removed);
  EXPECT_EQ(result.thin.PointCount() + result.removed + result.removed_by_cleanup,
            object.PointCount());
}

// A block around one corner of a brick with a hole beyond the corner across. With these spacings
// chamfer distances grow along this diagonal nearly as fast as anywhere, so the brick has 62
// shells, 7 to 68, of the 64 that planes tell apart; 4 looks like 68.
Volume BlockWithHoleBeyondABrick() {
  constexpr LatticePoint kCorner = {96, 32, 48};
  constexpr LatticePoint kHole = kCorner + LatticePoint{31, 7, 17};
  constexpr LatticeBox kBlock = {{22, 6, 10}, {170, 58, 86}};
  return test::VolumeWhere(
      {90, 40, 50},
      [&](int32_t x, int32_t y, int32_t z) {
        return kBlock.Contains(LatticePoint{x, y, z}) && LatticePoint{x, y, z} != kHole;
      },
      {.spacing = {1, 3, 2}});
}

TEST(Thinning, OpensEachPointWithItsShellWhereABrickHasNearlyAllThatPlanesTellApart) {
  const Volume object = BlockWithHoleBeyondABrick();
  const auto distance = ComputeDistance(object, DistanceKind::kChamfer, {});
  const double width = EffectiveShellWidth(kMinShellWidth, AxisScaleOf(object.placement()));
  std::vector<uint64_t> expected(200);
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    object.bricks()[n].ForEachSetBit([&](int bit) {
      ++expected.at(static_cast<size_t>(ShellOf(distance->At(n, bit), distance->weights(), width)));
    });
  }
  const BrickIndex brick = *object.Find(BrickKey({3, 4, 3, Sublattice::kEven}));
  const Shells shells = BuildShells(object, *distance, kMinShellWidth, {});
  ASSERT_EQ(shells.RangeOf(brick).first, 7);
  ASSERT_EQ(shells.RangeOf(brick).last, 68);

  exec::Context context;
  context.on_shell = [&](const exec::ShellProgress& at) {
    EXPECT_EQ(at.points, expected[static_cast<size_t>(at.shell)]) << "shell " << at.shell;
  };
  ASSERT_TRUE(ThinObject(object, *distance, {.shell_width = kMinShellWidth}, context).ok());
}

TEST(Thinning, KeepsExtentAndPlacement) {
  VolumeBuilder builder({30, 20, 10}, {.spacing = {1, 2, 3}, .origin = {4, 5, 6}});
  for (int i = 3; i < 25; ++i) {
    for (int j = 3; j < 9; ++j) builder.Add(PointAt(Sublattice::kOdd, i, j, 5));
  }
  const Volume object = *std::move(builder).Build();
  const Volume thin = Thin(object, {}).thin;
  EXPECT_EQ(thin.extent(), object.extent());
  EXPECT_EQ(thin.placement(), object.placement());
}

TEST(Thinning, OfAnEmptyObjectIsEmpty) {
  const ThinningResult result = Thin(Volume(), {});
  EXPECT_TRUE(result.thin.empty());
  EXPECT_EQ(result.last_shell, 0);
}

TEST(Thinning, RefusesBadOptionsWithValueAndLimit) {
  const Volume object = Blob(1);
  const auto distance = ComputeDistance(object, DistanceKind::kChamfer, {});
  for (double width : {0.0, 0.5, 65.0, std::nan("")}) {
    const auto status = ThinObject(object, *distance, {.shell_width = width}, {}).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("must be 0.75 to 64"), absl::string_view::npos) << status;
  }
  const auto status = ThinObject(object, *distance, {.last_shell = -1}, {}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
}

TEST(Thinning, StopsInTheMiddleWhenAskedWithAnyNumberOfThreads) {
  const Volume object = Blob(2);
  for (int threads : {1, 2, 8}) {
    std::stop_source source;
    test::TeamContext context(threads);
    context.stop = source.get_token();
    int32_t shells = 0;
    context.on_shell = [&](const exec::ShellProgress& p) {
      shells = p.shell;
      if (p.shell == 3) source.request_stop();
    };
    const auto result =
        ThinObject(object, *ComputeDistance(object, DistanceKind::kChamfer, {}), {}, context);
    EXPECT_EQ(result.status().code(), absl::StatusCode::kCancelled);
    EXPECT_EQ(shells, 3);
  }
}

TEST(ThinningState, FindsTheNeighborsOfEveryPoint) {
  const std::vector<LatticePoint> points = test::RandomCloud(4, {36, 12, 20}, 0.5);
  const Volume object = VolumeOfPoints(points);
  const test::ReferencePointSet reference(object);
  const ThinningState state(object, {});
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    object.bricks()[n].ForEachSetBit([&](int bit) {
      const LatticePoint p = PointOf(object.keys()[n].coordinates(), bit);
      ASSERT_EQ(state.NeighborsOf(n, bit), reference.NeighborsOf(p));
    });
  }
}

// Where a plain bar loses everything with other tools.
TEST(Thinning, LeavesACurveInAPlainBar) {
  const Volume thin = Thin(test::FullVolume({4, 4, 100}), {}).thin;
  EXPECT_GT(thin.PointCount(), 80u);
  EXPECT_LT(thin.PointCount(), 250u);
}

// A thin rod has one shell, from which the ends retreat by a point in each cycle.
TEST(Thinning, GoesOnAloneWithinTheLastShell) {
  std::vector<LatticePoint> points;
  for (int32_t z = 0; z < 4000; ++z) points.push_back({2 + z % 2, 2 + z % 2, z});
  const Volume rod = VolumeOfPoints(points);
  const auto distance = ComputeDistance(rod, DistanceKind::kEuclidean, {});
  const ThinningOptions kernel = {.method = ThinningMethod::kSymmetric,
                                  .kind = SkeletonKind::kKernel};
  const auto alone = ThinObject(rod, *distance, kernel, {});
  test::TeamContext context(2);
  context.patience = 1e9;
  int asked = 0;
  context.share = [&] { return ++asked > 20 ? 1 : 2; };  // a team that is alone does not ask
  const auto result = ThinObject(rod, *distance, kernel, context);
  ASSERT_TRUE(alone.ok() && result.ok());
  EXPECT_TRUE(result->thin == alone->thin);
  EXPECT_EQ(result->passes, alone->passes);
  EXPECT_GT(result->passes, 500);
  EXPECT_LT(asked, 50);
}

}  // namespace
}  // namespace bccskel::all_rules
