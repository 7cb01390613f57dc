// Twice the object takes at most 2.6 times the work, in every stage behind thinning and in every
// text format. Work is counted, not timed: the compiler calls the function below in each block of
// the sources under test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "client/export/graph_formats.h"
#include "client/export/json.h"
#include "core/pipeline/skeletonize.h"
#include "core/pruning/ball_index.h"
#include "tests/support/cell_patterns.h"

namespace {
uint64_t blocks = 0;
}

extern "C" void __sanitizer_cov_trace_pc() { ++blocks; }

namespace bccskel {
namespace {

using test::IsDust, test::IsIn, test::Net;

constexpr double kMostGrowth = 2.6;

struct Box {
  int32_t edge = 24;  // cells along x and y
  int32_t height = 12;
};

uint64_t WorkOf(const std::function<void()>& task) {
  const uint64_t before = blocks;
  task();
  return blocks - before;
}

// A single curve through the whole box, back and forth.
bool IsOneCurve(int32_t i, int32_t j, int32_t k, int sublattice) {
  if (sublattice != 0 || k % 4 > 2) return false;
  const bool row = j % 2 == 0 && k % 4 == 0, first = i == 0, last = i == Box().edge - 1;
  const bool turn = j % 2 == 1 && k % 4 == 0 && (j % 4 == 1 ? last : first);
  return row || turn;
}

// Voxels with all of their corners, as random as told.
IsIn Noise(double part) {
  const auto is_voxel = [part](int32_t i, int32_t j, int32_t k) {
    uint64_t hash = (static_cast<uint64_t>(k) << 20 | static_cast<uint64_t>(j) << 10 |
                     static_cast<uint64_t>(i)) +
                    1;
    for (int round = 0; round < 3; ++round) hash = (hash ^ hash >> 29) * 0x9E3779B97F4A7C15;
    return static_cast<double>(hash >> 11) < part * 0x1p53;
  };
  return [is_voxel](int32_t i, int32_t j, int32_t k, int sublattice) {
    if (sublattice == 1) return is_voxel(i, j, k);
    for (int corner = 0; corner < 8; ++corner) {
      const int32_t x = i - (corner & 1), y = j - (corner >> 1 & 1), z = k - (corner >> 2);
      if (std::min({x, y, z}) >= 0 && is_voxel(x, y, z)) return true;
    }
    return false;
  };
}

struct Formats {
  uint64_t graph = 0, json = 0, graphml = 0, vtp = 0, swc = 0, csv = 0, glb = 0, markups = 0,
           obj = 0;
};

Formats WorkFor(const Box& box, const IsIn& is_in, const SkeletonizeOptions& options) {
  const Volume object = test::VolumeOfCells({box.edge, box.edge, box.height}, is_in);
  absl::StatusOr<SkeletonizeResult> result;
  Formats work;
  work.graph = WorkOf([&] { result = Skeletonize(object, options, {}); });
  EXPECT_TRUE(result.ok()) << result.status();
  if (!result.ok()) return {};
  const SkeletonGraph& graph = result->graph;
  const TreeOrder order = OrderTrees(graph, {});
  work.json = WorkOf([&] { exporting::JsonText(*result, order); });
  work.graphml = WorkOf([&] { exporting::GraphMlText(graph, {.order = order}); });
  work.vtp = WorkOf([&] { exporting::VtpText(graph, {.order = order}); });
  work.swc = WorkOf([&] { exporting::WriteSwc(graph, order); });
  work.csv = WorkOf([&] { exporting::BranchTableText(graph, {.order = order}); });
  work.glb = WorkOf([&] { exporting::WriteGlb(graph).status().IgnoreError(); });
  work.markups = WorkOf([&] { exporting::WriteMarkups(graph, {}, {}); });
  work.obj = WorkOf([&] { exporting::ObjText(graph); });
  return work;
}

void ExpectLinear(const char* what, uint64_t once, uint64_t twice) {
  ASSERT_GT(once, 0u) << what;
  EXPECT_LT(static_cast<double>(twice) / static_cast<double>(once), kMostGrowth)
      << what << ": " << once << " and " << twice << " blocks";
}

void ExpectLinear(const IsIn& is_in, const SkeletonizeOptions& options = {}, Box box = {}) {
  const Formats once = WorkFor(box, is_in, options);
  box.height *= 2;
  const Formats twice = WorkFor(box, is_in, options);
  ExpectLinear("graph", once.graph, twice.graph);
  ExpectLinear("JSON", once.json, twice.json);
  ExpectLinear("GraphML", once.graphml, twice.graphml);
  ExpectLinear("VTP", once.vtp, twice.vtp);
  ExpectLinear("SWC", once.swc, twice.swc);
  ExpectLinear("CSV", once.csv, twice.csv);
  ExpectLinear("GLB", once.glb, twice.glb);
  ExpectLinear("markups", once.markups, twice.markups);
  ExpectLinear("OBJ", once.obj, twice.obj);
}

TEST(LinearGrowth, Dust) { ExpectLinear(&IsDust); }
TEST(LinearGrowth, DenseNet) { ExpectLinear(Net(2)); }
TEST(LinearGrowth, Net) { ExpectLinear(Net(4)); }
TEST(LinearGrowth, OneCurve) { ExpectLinear(&IsOneCurve); }

// Its clusters have many loops, and where it is dense, cavities.
TEST(LinearGrowth, Noise) {
  for (const double part : {0.35, 0.65}) {
    SCOPED_TRACE(part);
    ExpectLinear(Noise(part), {.source = ObjectSource::kVoxels}, {.edge = 32, .height = 20});
  }
}

// Their graphs have births, which are looked for in all points.
TEST(LinearGrowth, Isthmuses) {
  SkeletonizeOptions options;
  options.thinning.kind = SkeletonKind::kIsthmusCurve;
  ExpectLinear(Net(2), options);
}

TEST(LinearGrowth, Persistence) {
  SkeletonizeOptions options;
  options.thinning.kind = SkeletonKind::kIsthmusCurve;
  options.pruning.rule = PruningRule::kPersistence;
  ExpectLinear(Net(2), options);
  ExpectLinear(Noise(0.35), options, {.edge = 32, .height = 20});
}

// Walls of boxes.
TEST(LinearGrowth, Sheets) {
  SkeletonizeOptions options;
  options.thinning.kind = SkeletonKind::kSurface;
  const auto is_wall = [](int32_t i, int32_t j, int32_t k, int /*sublattice*/) {
    return i % 6 == 0 || j % 6 == 0 || k % 6 == 0;
  };
  ExpectLinear(is_wall, options);
  ExpectLinear(Noise(0.35), options, {.edge = 32, .height = 20});
}

// Curves to spines all over a ball, as dense on balls of any size, and how much work it is to find
// out whether the tip of one of them is covered.
uint64_t WorkForTip(double ball) {
  constexpr double kSpine = 3, kLength = 20, kSpacing = 16;
  const auto spines = static_cast<int>(4 * std::numbers::pi * std::pow(ball / kSpacing, 2));
  const auto middle = static_cast<int32_t>(ball + kLength);
  std::vector<LatticePoint> points;
  std::vector<float> radii;
  for (int n = 0; n < spines; ++n) {
    const double height = 1 - (2 * n + 1.0) / spines, across = std::sqrt(1 - height * height);
    const double turn = n * std::numbers::pi * (3 - std::sqrt(5.0));
    for (double out = kSpacing; out < ball + kLength; out += 2) {
      const auto at = [&](double way) { return middle + static_cast<int32_t>(out / 2 * way) * 2; };
      points.push_back({at(across * std::cos(turn)), at(across * std::sin(turn)), at(height)});
      radii.push_back(static_cast<float>(std::max(ball - out, kSpine)));
    }
  }
  const LatticePoint tip = points.back();
  ThinSet set({VolumeOfPoints({}), {}});
  for (size_t n = 0; n < points.size(); ++n) set.Add(points[n], radii[n]);
  BallIndex index(set);
  index.SetOwn(std::span(points).last(points.size() / static_cast<size_t>(spines)));
  return WorkOf([&] { EXPECT_FALSE(index.IsCovered(tip, kSpine, ball, set)); });
}

TEST(LinearGrowth, CoverOfTips) { EXPECT_LT(WorkForTip(240), 2 * WorkForTip(60)); }

}  // namespace
}  // namespace bccskel
