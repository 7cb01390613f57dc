// Radii of masks against those of the solids that the masks are samples of.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/core/labels/voxel_figure.h"

namespace bccskel::mask_radius {
namespace {

using Vector = std::array<double, 3>;

struct Solid {
  enum class Kind : uint8_t { kBall, kCylinder, kPlate };
  Kind kind = Kind::kBall;
  Vector center = {};
  Vector axis = {0, 0, 1};  // of the cylinder, or normal to the plate
  double radius = 1;        // or half the thickness

  double Depth(const Vector& at) const {
    const Vector way = Minus(at, center);
    const double along = Dot(way, axis);
    const double whole = Dot(way, way);
    if (kind == Kind::kBall) return radius - std::sqrt(whole);
    if (kind == Kind::kPlate) return radius - std::abs(along);
    return radius - std::sqrt(std::max(whole - along * along, 0.0));
  }
};

constexpr int32_t kEdge = 56;

SkeletonizeResult SkeletonOf(const Solid& solid, VoxelPoints points) {
  return test::SkeletonOf({.nx = kEdge, .ny = kEdge, .nz = kEdge}, {}, {.points = points},
                          [&](const test::Voxel& voxel) {
                            const auto [x, y, z] = voxel;
                            return solid.Depth({1.0 * x, 1.0 * y, 1.0 * z}) >= 0;
                          });
}

class MeanError {
 public:
  void Add(const SkeletonizeResult& result, const Solid& solid) {
    const SkeletonGraph& graph = result.graph;
    if (solid.kind == Solid::Kind::kBall) {
      const auto radius = [](const SkeletonNode& n) { return n.at.radius; };
      Add(graph.RadiusOf(std::ranges::max_element(graph.nodes, {}, radius)->at) - solid.radius);
      return;
    }
    // Where the border of the box is far away.
    const double margin = 2 * solid.radius + 4;
    for (const SkeletonPoint& p : graph.points) {
      const WorldPoint at = graph.PositionOf(p);
      const auto [low, high] = std::ranges::minmax(at);
      if (low < margin || high > kEdge - 1 - margin) continue;
      Add(graph.RadiusOf(p) - solid.radius);
    }
  }
  double Get() const { return sum_ / count_; }

 private:
  void Add(double error) {
    sum_ += error;
    ++count_;
  }
  double sum_ = 0;
  int count_ = 0;
};

Vector RandomAxis(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vector axis = {normal(random), normal(random), normal(random)};
  const double length = std::sqrt(Dot(axis, axis));
  for (double& c : axis) c /= length;
  return axis;
}

enum class Axis : uint8_t { kOfTheGrid, kRandom };

// Of solids whose radii and places fill the ranges of a voxel evenly.
double MeanErrorOf(Solid::Kind kind, Axis axis, double radius, VoxelPoints points) {
  constexpr int kSolids = 16;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0, 1);
  MeanError error;
  for (int n = 0; n < kSolids; ++n) {
    Solid solid = {.kind = kind, .radius = radius + (n + 0.5) / kSolids - 0.5};
    for (double& c : solid.center) c = kEdge / 2 + part(random);
    solid.center[2] = kEdge / 2 + (5 * n % kSolids + 0.5) / kSolids;
    if (axis == Axis::kRandom) solid.axis = RandomAxis(random);
    error.Add(SkeletonOf(solid, points), solid);
  }
  return error.Get();
}

TEST(MaskRadius, IsThatOfTheSolidWithinATenthOfAVoxelInTheMean) {
  using Kind = Solid::Kind;
  for (VoxelPoints points : {VoxelPoints::kTwo, VoxelPoints::kSixteen}) {
    for (double radius : {1.5, 3.0, 6.0}) {
      if (points == VoxelPoints::kSixteen && radius > 3) continue;  // takes long
      SCOPED_TRACE(testing::Message() << static_cast<int>(points) << ", radius " << radius);
      const bool small_and_fine = points == VoxelPoints::kSixteen && radius < 2;
      const double most = small_and_fine ? 0.2 : 0.1;
      EXPECT_NEAR(MeanErrorOf(Kind::kBall, Axis::kRandom, radius, points), 0, most);
      EXPECT_NEAR(MeanErrorOf(Kind::kCylinder, Axis::kOfTheGrid, radius, points), 0, 0.1);
      EXPECT_NEAR(MeanErrorOf(Kind::kCylinder, Axis::kRandom, radius, points), 0, 0.1);
      EXPECT_NEAR(MeanErrorOf(Kind::kPlate, Axis::kOfTheGrid, radius, points), 0, 0.1);
      // Flat surfaces across the grid: the nearest of few voxels lies farther outside.
      EXPECT_NEAR(MeanErrorOf(Kind::kPlate, Axis::kRandom, radius, points), 0.1, 0.15);
    }
  }
}

// A slab as many voxels thick as it is: hardly an error, also where voxels are no cubes.
TEST(MaskRadius, OfASlabIsHalfItsThickness) {
  for (const auto& [thickness, edge] :
       {std::pair(1, 1.0), {1, 2.5}, {2, 2.5}, {5, 2.5}, {6, 2.5}, {9, 2.5}, {10, 2.5}, {3, 8.0}}) {
    MaskGrid grid = {.nx = 128, .ny = 64, .nz = 20};
    grid.placement.spacing = {1, 1, edge};
    auto converter = *MaskConverter::Create(grid, {});
    const std::vector<uint64_t> empty(grid.WordsPerSlice()), full(grid.WordsPerSlice(), ~0ULL);
    for (int32_t z = 0; z < grid.nz; ++z) {
      ASSERT_TRUE(converter.AddSlice(z >= 3 && z < 3 + thickness ? full : empty, {}).ok());
    }
    const ConvertedMask converted = *std::move(converter).Finish();
    const SkeletonizeResult result = *Skeletonize(converted.volume, ForMask({}, grid, {}), {});
    int count = 0;
    for (const SkeletonPoint& p : result.graph.points) {
      const WorldPoint at = result.graph.PositionOf(p);
      if (std::min({at[0], at[1], 127 - at[0], 63 - at[1]}) < 0.52 * edge * thickness + 8) continue;
      EXPECT_NEAR(result.graph.RadiusOf(p), edge * thickness / 2, 0.1) << at[2];
      ++count;
    }
    EXPECT_GT(count, 0) << thickness;
  }
}

// Walks in steps of all kinds: where voxels meet in an edge or a corner the solid has no thickness.
TEST(MaskRadius, OfAnyPartIsHalfAVoxelAtLeast) {
  for (VoxelPoints points : {VoxelPoints::kTwo, VoxelPoints::kSixteen}) {
    for (double thick : {1.0, 4.0}) {
      MaskGrid grid = {.nx = 64, .ny = 20, .nz = 20};
      grid.placement.spacing = {2, 2, 2 * thick};
      std::vector<std::vector<uint64_t>> slices(20, std::vector<uint64_t>(grid.WordsPerSlice()));
      std::mt19937 random(7);
      std::uniform_int_distribution<int> step(-1, 1);
      for (int walk = 0; walk < 4; ++walk) {
        int y = 10, z = 5 + 3 * walk;
        for (int x = 1; x < 63; ++x) {
          slices[static_cast<size_t>(z)][static_cast<size_t>(y)] |= uint64_t{1} << x;
          y = std::clamp(y + step(random), 1, 18);
          z = std::clamp(z + step(random), 0, 19);
        }
      }
      const MaskOptions options = {.points = points};
      auto converter = *MaskConverter::Create(grid, options);
      for (const auto& words : slices) ASSERT_TRUE(converter.AddSlice(words, {}).ok());
      const ConvertedMask converted = *std::move(converter).Finish();
      const SkeletonGraph graph =
          Skeletonize(converted.volume, ForMask({}, grid, options), {})->graph;
      ASSERT_GT(graph.points.size(), 100u);
      for (const SkeletonPoint& p : graph.points) EXPECT_GE(graph.RadiusOf(p), 0.999);
      for (const SkeletonNode& n : graph.nodes) EXPECT_GE(graph.RadiusOf(n.at), 0.999);
    }
  }
}

}  // namespace
}  // namespace bccskel::mask_radius
