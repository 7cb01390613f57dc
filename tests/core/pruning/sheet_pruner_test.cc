#include "core/pruning/sheet_pruner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/import/shapes/figures.h"
#include "core/skeleton/trace_skeleton.h"
#include "core/topology/simple_point_table.h"
#include "tests/core/pruning/raw_curves.h"
#include "tests/core/pruning/simple_noise.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using shapes::BallShell;
using shapes::Block;
using shapes::Solid;
using shapes::Spheroid;
using shapes::Vector;
using test::RawCurves;

RawCurves SheetsOf(const Solid& solid, double noise, uint64_t points = 60'000) {
  const std::vector<Solid> figure = {solid};
  Volume object = *shapes::GenerateFigure(figure, {.points = points});
  if (noise > 0) object = test::WithSimpleNoise(object, noise, 1);
  return RawCurves(std::move(object), SkeletonKind::kSurface);
}

Block TurnedBlock(Vector half_edges) {
  const Vector first = shapes::Unit({1, 0.3, 0.2}), some = {-0.3, 1, 0.15};
  return {half_edges, first, shapes::Unit(some - Dot(first, some) * first)};
}

ThinSkeleton Pruned(const RawCurves& raw, double margin = kDefaultSheetMargin,
                    const std::vector<LatticePoint>& keep = {}) {
  return *PruneSheets(raw.skeleton, margin, keep, {});
}

struct Counts {
  size_t ends = 0;
  size_t rim = 0;  // simple points
};

Counts CountsOf(const Volume& thin) {
  const ThinSet set({thin, std::vector<float>(thin.PointCount())});
  Counts counts;
  set.ForEachPoint([&](LatticePoint p) {
    const NeighborMask mask = set.NeighborsOf(p);
    counts.ends += IsEndPoint(mask) ? 1 : 0;
    counts.rim += IsSimple(mask) ? 1 : 0;
  });
  return counts;
}

TEST(PruneSheets, LeavesNoRimOfAClosedShellWithNoise) {
  const RawCurves raw = SheetsOf(BallShell{10, 8}, 0.05);
  EXPECT_GT(CountsOf(raw.skeleton.points).ends, 200u);
  const Counts counts = CountsOf(Pruned(raw).points);
  EXPECT_EQ(counts.ends, 0u);
  EXPECT_EQ(counts.rim, 0u);
}

TEST(PruneSheets, LeavesNoHairAtTheRimOfADisk) {
  const Spheroid disk = {{0, 0, 0}, shapes::Unit({1, 0.3, 0.2}), 1, 8};
  for (const double noise : {0.0, 0.05}) {
    const RawCurves raw = SheetsOf(disk, noise);
    EXPECT_GT(CountsOf(raw.skeleton.points).ends, 10u);
    EXPECT_LE(CountsOf(Pruned(raw).points).ends, 1u) << "noise " << noise;
  }
}

TEST(PruneSheets, LeavesAPlateItsCornersAtMost) {
  const RawCurves raw = SheetsOf(TurnedBlock({10, 6, 1}), 0);
  EXPECT_GT(CountsOf(raw.skeleton.points).ends, 90u);
  EXPECT_LE(CountsOf(Pruned(raw).points).ends, 8u);
}

// Where an edge of the object runs askew to the lattice, its bevel is a comb, and its teeth end in
// small patches of sheet.
TEST(PruneSheets, LeavesNoCombOfABevelInAnyPose) {
  for (const Vector half_edges : {Vector{10, 7, 1}, Vector{18, 13, 7}, Vector{1, 1, 1}}) {
    for (const Vector first : {Vector{1, 0.3, 0.2}, Vector{0.4, 1, -0.7}, Vector{-0.2, 0.6, 1}}) {
      for (const uint64_t points : {60'000u, 300'000u}) {
        const Vector turned = shapes::Unit(first), some = {-0.3, 1, 0.15};
        const Block block = {half_edges, turned, shapes::Unit(some - Dot(turned, some) * turned)};
        const ThinSkeleton pruned = Pruned(SheetsOf(block, 0, points));
        exec::UnlimitedMemory memory;
        const SkeletonGraph graph = *TraceSkeleton(pruned, memory, {});
        const auto ends = std::ranges::count(graph.nodes, NodeKind::kEnd, &SkeletonNode::kind);
        EXPECT_LE(ends, 2) << half_edges.x << " " << first.x << " " << points;
      }
    }
  }
}

// They are worth what is behind them.
TEST(PruneSheets, LeavesTheBevelsOfABox) {
  const RawCurves raw = SheetsOf(Block{{3, 2, 1}}, 0);
  EXPECT_GT(10 * Pruned(raw).points.PointCount(), 9 * raw.skeleton.points.PointCount());
}

TEST(PruneSheets, LeavesTheMiddleOfAPlateWithNoise) {
  const RawCurves clean = SheetsOf(Block{{10, 6, 1}}, 0), noisy = SheetsOf(Block{{10, 6, 1}}, 0.05);
  const auto clean_points = static_cast<double>(Pruned(clean).points.PointCount());
  const auto noisy_points = static_cast<double>(Pruned(noisy).points.PointCount());
  EXPECT_GT(static_cast<double>(noisy.skeleton.points.PointCount()), 1.6 * clean_points);
  EXPECT_GT(noisy_points, 0.9 * clean_points);
  EXPECT_LT(noisy_points, 1.4 * clean_points);
}

TEST(PruneSheets, TakesMoreByALargerMargin) {
  const RawCurves raw = SheetsOf(TurnedBlock({3, 2, 1}), 0.02);
  size_t before = raw.skeleton.points.PointCount();
  for (const double margin : {1.0, 3.0, 8.0}) {
    const size_t points = Pruned(raw, margin).points.PointCount();
    EXPECT_LT(points, before) << margin;
    before = points;
  }
}

TEST(PruneSheets, LeavesWhatIsKept) {
  const RawCurves raw = SheetsOf(BallShell{10, 8}, 0.05);
  const std::vector<LatticePoint> keep = {ThinSet(raw.skeleton).Ends().front()};
  EXPECT_TRUE(Pruned(raw, kDefaultSheetMargin, keep).points.Contains(keep.front()));
  EXPECT_FALSE(Pruned(raw).points.Contains(keep.front()));
}

TEST(PruneSheetsLaw, KeepsTheTopologyAndGivesRadiiInOrder) {
  for (uint64_t seed = 0; seed < 30 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const auto blob =
        test::WithNoisyBoundary(seed, test::RandomBlob(seed, {16, 16, 16}, 5, 9), 0.2);
    const RawCurves raw(VolumeOfPoints(blob), SkeletonKind::kSurface);
    for (const double margin : {1.0, kDefaultSheetMargin, 100.0}) {
      const ThinSkeleton pruned = Pruned(raw, margin);
      EXPECT_EQ(*CountBettiNumbers(pruned.points, {}), *CountBettiNumbers(raw.skeleton.points, {}));
      const ThinSet set(raw.skeleton);
      size_t n = 0;
      ASSERT_EQ(pruned.radii.size(), pruned.points.PointCount());
      pruned.points.ForEachPoint([&](LatticePoint p) {
        ASSERT_TRUE(set.Contains(p));
        EXPECT_EQ(pruned.radii[n++], set.RadiusOf(p));
      });
    }
  }
}

}  // namespace
}  // namespace bccskel
