#include "client/view/first_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace bccskel::view {
namespace {

TEST(FirstViewTest, ASliceIsSeenAsProgramsShowImages) {
  const auto box = [](double z) { return WorldBox{{0, 0, 0}, {40, 30, z}}; };
  const Front front = FrontOf(box(2), {}, SliceFacts{1, 1, "unknown"});
  EXPECT_EQ(front.view.right, (WorldPoint{1, 0, 0}));
  EXPECT_EQ(front.view.up, (WorldPoint{0, -1, 0}));
  EXPECT_EQ(front.view.toward, (WorldPoint{0, 0, -1}));
  EXPECT_EQ(ViewsOf(front)[0].toward, front.view.toward);
  EXPECT_EQ(FrontOf(box(2), {}, SliceFacts{1, 1, "LPS"}).view.up, front.view.up);
  const Front anterior = FrontOf(box(2), {}, SliceFacts{1, 1, "RAS"});
  EXPECT_EQ(anterior.view.up, (WorldPoint{0, 1, 0}));
  EXPECT_EQ(anterior.turn, 0);
  // Two slices, a mesh, and an image that is no wider than thick.
  EXPECT_EQ(FrontOf(box(3), {}, SliceFacts{1, 1, ""}).turn, 30);
  EXPECT_EQ(FrontOf(box(2), {}, std::nullopt).turn, 30);
  EXPECT_EQ(FrontOf({{0, 0, 0}, {1.9, 30, 2}}, {}, SliceFacts{1, 1, ""}).turn, 30);
  // One slice and two of them, cut into slabs.
  EXPECT_EQ(FrontOf(box(11), {}, SliceFacts{1, 10, ""}).turn, 0);
  EXPECT_EQ(FrontOf(box(21), {}, SliceFacts{1, 10, ""}).turn, 30);
  // The surface of a large image may be coarse.
  EXPECT_EQ(FrontOf({{0, 0, -2}, {400, 300, 2}}, {}, SliceFacts{1, 1, ""}).turn, 0);
}

// Plates across the x-z plane, turned to the left and to the right.
TEST(FirstViewTest, APlateDoesNotShowItsEdge) {
  for (const double turned : {-1.0, 1.0}) {
    std::vector<WorldPoint> points;
    for (int across = -10; across <= 10; ++across) {
      for (int up = -10; up <= 10; ++up) {
        points.push_back({static_cast<double>(across), static_cast<double>(up), turned * across});
      }
    }
    const Front front = FrontOf(BoxOf(points), points, std::nullopt);
    const View view = ViewsOf(front)[0];
    const double cosine = (view.toward[2] - turned * view.toward[0]) / std::sqrt(2.0);
    EXPECT_GT(std::abs(cosine), 0.8) << turned;
  }
}

}  // namespace
}  // namespace bccskel::view
