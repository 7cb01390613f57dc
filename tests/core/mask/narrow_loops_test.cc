// Loops of masks that are as narrow as noise makes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/pipeline/notes.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/core/mask/mask_words.h"

namespace bccskel {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A bar of 40 x 7 x 7 voxels with square holes across it, each as wide as told, and a voxel in the
// middle of the last one, or just above if it is that narrow, if there shall be dust.
SkeletonizeResult BarWithHoles(std::initializer_list<int32_t> widths, double voxel,
                               const PreparingOptions& preparing = {}, bool dust = false) {
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
  SkeletonizeOptions options = {.source = ObjectSource::kVoxels};
  options.preparing = preparing;
  return *Skeletonize(Converted(mask, {}, placement).volume, options, {});
}

TEST(NarrowLoops, AreCountedByTheWidthOfTheirTunnels) {
  for (double voxel : {1.0, 8.0}) {
    const SkeletonGraph graph = BarWithHoles({1, 1, 5}, voxel).graph;
    ASSERT_EQ(TotalOf(ComponentsOf(graph)).loops, 3u);
    EXPECT_EQ(CountNarrowLoops(graph, 2 * voxel), 2u);
    EXPECT_EQ(CountNarrowLoops(graph, 12 * voxel), 3u);
  }
}

TEST(NarrowLoops, AreNotedWithTheOptionThatClosesThem) {
  const SkeletonizeResult result = BarWithHoles({1, 1, 5}, 8);
  EXPECT_THAT(NotesOn(result), ElementsAre("2 loops are narrower than 2 voxels, as noise makes "
                                           "them; --cut-loops 16 closes such tunnels before "
                                           "thinning"));
  const SkeletonizeResult closed = BarWithHoles({1, 1, 5}, 8, {.tunnel_width = 16});
  EXPECT_EQ(closed.certificate.skeleton.loops, 1);
  EXPECT_THAT(NotesOn(closed), ElementsAre(HasSubstr("loops 3 -> 1")));
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

}  // namespace
}  // namespace bccskel
