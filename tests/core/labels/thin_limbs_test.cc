// Limbs one to four voxels thick in stacks: the length of their curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/distance/places.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/core/labels/voxel_figure.h"

namespace bccskel {
namespace {

using test::Voxel;

double LengthOf(const SkeletonizeResult& result) {
  return TotalOf(ComponentsOf(result.graph)).length;
}

MaskGrid StackOf(double slice) {
  MaskGrid grid = {.nx = 100, .ny = 60, .nz = static_cast<int32_t>(40 / slice) + 1};
  grid.placement.spacing = {1, 1, slice};
  return grid;
}

TEST(ThinLimbs, BarsHaveTheLengthOfTheirMiddleLine) {
  for (const double slice : {1.0, 2.0, 3.0}) {
    for (const auto& bar : {std::array{4, 1}, {6, 1}, {1, 2}, {3, 2}, {2, 2}, {1, 1}}) {
      const int width = bar[0], slices = bar[1];  // clang 14 captures no structured binding
      const SkeletonizeResult result = SkeletonOf(StackOf(slice), {}, {}, [&](const Voxel& at) {
        return at[0] >= 10 && at[0] < 90 && at[1] >= 30 && at[1] < 30 + width && at[2] >= 4 &&
               at[2] < 4 + slices;
      });
      ASSERT_EQ(result.graph.edges.size(), 1u);
      const SkeletonGraph& graph = result.graph;
      const double straight =
          DistanceBetween(graph.PositionOf(graph.nodes[0].at), graph.PositionOf(graph.nodes[1].at));
      EXPECT_NEAR(LengthOf(result) / straight, 1, 0.035)
          << width << " by " << slices << " voxels, slices of " << slice;
    }
  }
}

// A sine in three dimensions.
std::vector<Coordinates> Wave(double phase) {
  std::vector<Coordinates> wave;
  for (double t = 0; t <= 1; t += 1.0 / 256) {
    wave.push_back(
        {10 + 80 * t, 30 + 15 * std::sin(9 * t + 2 * phase), 20 + 6 * std::sin(6 * t + phase)});
  }
  return wave;
}

TEST(ThinLimbs, CurvedOnesHaveTheLengthOfTheirMiddleLine) {
  for (const double slice : {1.0, 2.0, 3.0}) {
    for (const double radius : {1.5, 2.0, 3.0}) {
      for (const double phase : {0.0, 1.0}) {
        if (radius * 2 == slice && phase == 1) continue;  // in two pieces
        const std::vector<Coordinates> wave = Wave(phase);
        double length = 0;
        for (size_t n = 1; n < wave.size(); ++n) length += DistanceBetween(wave[n - 1], wave[n]);
        const SkeletonizeResult result = SkeletonOf(StackOf(slice), {}, {}, [&](const Voxel& at) {
          const Coordinates place = {1.0 * at[0], 1.0 * at[1], slice * at[2]};
          return std::ranges::any_of(wave, [&](const Coordinates& middle) {
            return DistanceBetween(place, middle) <= radius;
          });
        });
        ASSERT_EQ(result.graph.edges.size(), 1u);
        EXPECT_NEAR(LengthOf(result) / length, 1, 0.07)
            << "radius " << radius << ", slices of " << slice << ", phase " << phase;
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
