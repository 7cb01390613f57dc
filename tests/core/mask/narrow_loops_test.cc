// Loops of masks that are as narrow as noise makes them.
#include "core/skeleton/narrow_loops.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <tuple>
#include <vector>

#include "core/pipeline/notes.h"
#include "core/pipeline/presets.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/core/mask/mask_words.h"

namespace bccskel {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// A bar of 40 x 7 x 7 voxels with square holes across it, each as wide as told, and a voxel in the
// middle of the last one, or just above if it is that narrow, if there shall be dust.
SkeletonizeResult BarWithHoles(std::initializer_list<int32_t> widths, double voxel,
                               const PreparingOptions& preparing = {}, bool dust = false,
                               VoxelPoints points = VoxelPoints::kTwo) {
  test::ReferenceMask mask{44, 20, 11, std::vector<uint8_t>(44 * 20 * 11)};
  const auto set = [&](int32_t x, int32_t y, uint8_t value) {
    for (int32_t z = 1; z < 8; ++z) mask.voxels[mask.Index(x, y, z)] = value;
  };
  int32_t margin = 0;
  for (int32_t width : widths) margin = std::max(margin, width / 2);
  for (int32_t x = 2; x < 42; ++x) {
    for (int32_t y = 7 - margin; y < 14 + margin; ++y) set(x, y, 1);
  }
  int32_t at = 10;
  for (int32_t width : widths) {
    for (int32_t x = at; x < at + width; ++x) {
      for (int32_t y = 10 - width / 2; y < 10 - width / 2 + width; ++y) set(x, y, 0);
    }
    at += width + 9;
  }
  const int32_t width = widths.end()[-1];
  if (dust) mask.voxels[mask.Index(at - 9 - width + width / 2, 10, width > 1 ? 4 : 9)] = 1;
  Placement placement;
  placement.spacing = {voxel, voxel, voxel};
  const bool two = points == VoxelPoints::kTwo;
  SkeletonizeOptions options = {.source =
                                    two ? ObjectSource::kVoxels : ObjectSource::kRefinedVoxels};
  options.preparing = preparing;
  return *Skeletonize(Converted(mask, {.points = points}, placement).volume, options, {});
}

TEST(NarrowLoops, AreCountedByTheWidthOfTheirTunnels) {
  for (double voxel : {1.0, 8.0}) {
    const SkeletonGraph graph = BarWithHoles({1, 1, 5}, voxel).graph;
    ASSERT_EQ(TotalOf(ComponentsOf(graph)).loops, 3u);
    EXPECT_EQ(CountNarrowLoops(graph, 2 * voxel), 2u);
    EXPECT_EQ(CountNarrowLoops(graph, 12 * voxel), 3u);
  }
}

// A frame around a hole of so many voxels, as thick as told on two sides and three times that on
// the others.
SkeletonGraph Frame(std::array<int32_t, 2> hole, int32_t limb, const std::array<double, 3>& voxel) {
  const auto [width, height] = hole;
  const LatticePoint edges = {width + 4 * limb, height + 4 * limb, 3 * limb};
  const LatticeBox plate = {{2, 2, 2}, LatticePoint{1, 1, 1} + edges};
  const auto mask =
      test::MaskWhere(edges.x + 4, edges.y + 4, edges.z + 4,
                      [&, width = width, height = height](int32_t x, int32_t y, int32_t z) {
                        const int32_t right = x - 2 - limb, up = y - 2 - limb;
                        const bool is_hole = 0 <= right && right < width && 0 <= up && up < height;
                        return plate.Contains(LatticePoint{x, y, z}) && !is_hole;
                      });
  Placement placement;
  placement.spacing = voxel;
  return Skeletonize(Converted(mask, {}, placement).volume, {.source = ObjectSource::kVoxels}, {})
      ->graph;
}

TEST(NarrowLoops, AreMeasuredBetweenLimbsOfAnyThickness) {
  for (const int32_t limb : {1, 2, 3}) {
    for (const auto& [voxel, narrow, wide] :
         {std::tuple{std::array{1.0, 1.0, 1.0}, std::array{1, 1}, std::array{4, 4}},
          {std::array{2.0, 3.0, 4.0}, std::array{1, 2}, std::array{3, 4}},
          {std::array{1.0, 1.0, 3.0}, std::array{1, 3}, std::array{5, 5}}}) {
      const double width = 2.5 * *std::ranges::min_element(voxel);
      EXPECT_EQ(CountNarrowLoops(Frame(narrow, limb, voxel), width), 1u)
          << limb << ", " << voxel[2];
      EXPECT_EQ(CountNarrowLoops(Frame(wide, limb, voxel), width), 0u) << limb << ", " << voxel[2];
    }
  }
}

// A plate with 16 holes of a voxel; those inside the grid have four sides.
SkeletonizeResult GridOfHoles() {
  constexpr LatticeBox kPlate = {{2, 2, 2}, {43, 43, 8}};
  const auto mask = test::MaskWhere(50, 50, 11, [&](int32_t x, int32_t y, int32_t z) {
    return kPlate.Contains(LatticePoint{x, y, z}) && (x % 9 != 0 || y % 9 != 0);
  });
  return *Skeletonize(Converted(mask, {}, {}).volume, {.source = ObjectSource::kVoxels}, {});
}

TEST(NarrowLoops, AreCountedInAGridOfHoles) {
  const SkeletonGraph graph = GridOfHoles().graph;
  ASSERT_EQ(TotalOf(ComponentsOf(graph)).loops, 16u);
  EXPECT_EQ(CountNarrowLoops(graph, 3), 16u);
}

TEST(NarrowLoops, AreNotedWithTheOptionThatClosesThem) {
  const SkeletonizeResult result = BarWithHoles({1, 1, 5}, 8);
  EXPECT_THAT(NotesOn(result),
              ElementsAre("at least 2 loops are narrower than 2 voxels, as noise produces "
                          "them; --cut-loops 16 closes such tunnels before "
                          "thinning"));
  const SkeletonizeResult closed = BarWithHoles({1, 1, 5}, 8, {.tunnel_width = 16});
  EXPECT_EQ(closed.certificate.skeleton.loops, 1);
  EXPECT_THAT(NotesOn(closed), ElementsAre(HasSubstr("loops 3 -> 1")));
}

TEST(NarrowLoops, AreNotedWithTheOptionForRoughSurfacesIfThereAreMany) {
  SkeletonizeResult result = GridOfHoles();
  EXPECT_THAT(NotesOn(result),
              Contains(HasSubstr("before thinning; if the surface is rough, --denoise 2 "
                                 "--min-component 200 smooths it but removes limbs")));
  result.options.preparing.denoise_passes = 1;
  EXPECT_THAT(NotesOn(result), Contains(HasSubstr("--cut-loops 2 closes")));
  EXPECT_THAT(NotesOn(result), Each(Not(HasSubstr("--denoise"))));
}

TEST(NarrowLoops, AreNotedWithFewDigits) {
  EXPECT_THAT(NotesOn(BarWithHoles({1, 5}, 0.1762174)),
              ElementsAre(HasSubstr("--cut-loops 0.353 closes")));
}

TEST(NarrowLoops, AreClosedByWidthsInVoxelsForAnyNumberOfPointsPerVoxel) {
  for (const VoxelPoints points : {VoxelPoints::kTwo, VoxelPoints::kSixteen}) {
    const SkeletonizeResult result = BarWithHoles({1, 3, 5}, 8, {.tunnel_cells = 4}, false, points);
    EXPECT_EQ(result.certificate.skeleton.loops, 1);
  }
}

TEST(NarrowLoops, StayWithDustInThemUnlessItIsDropped) {
  const SkeletonizeResult stays = BarWithHoles({1, 3}, 1, {.tunnel_cells = 4}, true);
  EXPECT_EQ(stays.certificate.input, (BettiNumbers{2, 1, 0}));
  const SkeletonizeResult closed =
      BarWithHoles({1, 3}, 1, {.min_component_points = 200, .tunnel_cells = 4}, true);
  EXPECT_EQ(closed.certificate.input, (BettiNumbers{1, 0, 0}));
}

TEST(NarrowLoops, AreNotedWithTheDustThatKeepsThem) {
  const SkeletonizeResult stays = BarWithHoles({1}, 1, {.tunnel_cells = 4}, true);
  EXPECT_EQ(stays.certificate.input, (BettiNumbers{2, 1, 0}));
  EXPECT_THAT(NotesOn(stays), ElementsAre(HasSubstr("--min-component 200 drops specks before")));
}

TEST(NarrowLoops, AreNotNotedWhereAllAreWide) {
  EXPECT_THAT(NotesOn(BarWithHoles({5}, 1)), IsEmpty());
}

// A grid of rods with gaps of 14 between them, of slices `step` thick, half of whose voxels are in
// the rods, with noise on its surface if wanted.
test::ReferenceMask RodsInSlices(int32_t step, bool noisy) {
  constexpr int32_t kEdge = 72, kPeriod = 24, kRadius = 5;
  const auto is_in = [](int32_t x, int32_t y, int32_t z) {
    const auto off = [](int32_t at) { return at % kPeriod - kPeriod / 2; };
    const auto square = [&](int32_t a, int32_t b) { return off(a) * off(a) + off(b) * off(b); };
    return std::min({square(x, y), square(y, z), square(z, x)}) < kRadius * kRadius;
  };
  const auto clean =
      test::MaskWhere(kEdge, kEdge, kEdge / step, [&](int32_t x, int32_t y, int32_t z) {
        int32_t inside = 0;
        for (int32_t n = 0; n < step; ++n) inside += is_in(x, y, step * z + n) ? 1 : 0;
        return 2 * inside >= step;
      });
  if (!noisy) return clean;
  const LatticeBox inner = {{1, 1, 1}, {clean.nx - 2, clean.ny - 2, clean.nz - 2}};
  std::mt19937 random(1);
  return test::MaskWhere(clean.nx, clean.ny, clean.nz, [&](int32_t x, int32_t y, int32_t z) {
    if (!inner.Contains(LatticePoint{x, y, z})) return clean.Contains(x, y, z);
    int32_t inside = 0;
    for (int32_t n = 0; n < 27; ++n) {
      inside += clean.Contains(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1) ? 1 : 0;
    }
    const bool flips = inside > 0 && inside < 27 && random() % 8 == 0;
    return clean.Contains(x, y, z) != flips;
  });
}

TEST(NarrowLoops, OfNoiseGoAndOthersStayHoweverThickTheSlicesAre) {
  for (const int32_t step : {1, 2, 3}) {
    Placement placement;
    placement.spacing = {1, 1, static_cast<double>(step)};
    const auto loops_of = [&](bool noisy, const SkeletonizeOptions& options) {
      const Volume object = Converted(RodsInSlices(step, noisy), {}, placement).volume;
      return Skeletonize(object, options, {})->certificate.input.loops;
    };
    SkeletonizeOptions options = {.source = ObjectSource::kVoxels};
    options.thinning.kind = SkeletonKind::kKernel;
    const int64_t loops = loops_of(false, options);
    EXPECT_GT(loops, 20);
    EXPECT_GT(loops_of(true, options), 4 * loops);
    for (const char* preset : {"vessels", "neuron"}) {
      ASSERT_TRUE(ApplyPreset(preset, options).ok());
      EXPECT_EQ(loops_of(false, options), loops) << preset << ", " << step;
      EXPECT_LE(std::abs(loops_of(true, options) - loops), 4) << preset << ", " << step;
    }
  }
}

}  // namespace
}  // namespace bccskel
