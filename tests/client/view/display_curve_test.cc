#include "client/view/display_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "client/export/json.h"
#include "tests/client/export/sample_skeletons.h"

namespace bccskel::view {
namespace {

using ::testing::IsEmpty;

double SharpestTurn(std::span<const WorldPoint> curve) {
  double sharpest = 0;
  for (size_t n = 1; n + 1 < curve.size(); ++n) {
    double square = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double bend = curve[n - 1][axis] - 2 * curve[n][axis] + curve[n + 1][axis];
      square += bend * bend;
    }
    sharpest = std::max(sharpest, square);
  }
  return sharpest;
}

TEST(DisplayCurveTest, IsSmoothAndKeepsItsEnds) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTree);
  auto document = ParseResultDocument(exporting::JsonText(sample.result));
  ASSERT_TRUE(document.ok()) << document.status();
  for (const bool smooth : {true, false}) {  // results of older versions have no curves
    if (!smooth) document->curves.clear();
    const std::vector<WorldPoint> curves = *DisplayCurvesOf(*document, {});
    ASSERT_EQ(curves.size(), document->points.size());
    double sharpest = 0, sharpest_step = 0;
    for (const ResultDocument::Edge& edge : document->edges) {
      const auto curve = std::span(curves).subspan(edge.first_point, edge.point_count);
      const auto points = document->PointsOf(edge);
      EXPECT_EQ(curve.front(), points.front());
      EXPECT_EQ(curve.back(), points.back());
      sharpest = std::max(sharpest, SharpestTurn(curve));
      sharpest_step = std::max(sharpest_step, SharpestTurn(points));
    }
    EXPECT_LT(sharpest, sharpest_step / 4);
  }
  EXPECT_THAT(*DisplayCurvesOf({}, {}), IsEmpty());
}

}  // namespace
}  // namespace bccskel::view
