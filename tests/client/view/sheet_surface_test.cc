#include "client/view/sheet_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "client/export/json.h"
#include "client/view/page.h"
#include "client/view/result_balls.h"
#include "tests/client/export/sample_skeletons.h"
#include "tests/support/volume_where.h"

namespace bccskel::view {
namespace {

constexpr Placement kTilted = {.spacing = {0.5, 2, 1},
                               .origin = {10, -20, 5},
                               .direction = {0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1}};

struct Thinned {
  Volume object;
  SkeletonizeResult result;
  ResultDocument document;
};

Thinned ThinnedBox(SkeletonKind kind, const Placement& placement = {}) {
  constexpr LatticeBox kBox = {{4, 4, 4}, {55, 35, 19}};
  Volume object = test::VolumeWhere(
      {30, 20, 12},
      [&](int32_t x, int32_t y, int32_t z) {
        return kBox.Contains(LatticePoint{x, y, z});
      },
      placement);
  SkeletonizeOptions options;
  options.thinning.kind = kind;
  SkeletonizeResult result = Skeletonize(object, options, {}).value();
  ResultDocument document = ParseResultDocument(exporting::JsonText(result)).value();
  return {std::move(object), std::move(result), std::move(document)};
}

Volume BallsIn(const Volume& object, const std::vector<OpenBall>& balls) {
  return UnionOfBalls(balls, object.extent(), object.placement(), {}).value();
}

TEST(ResultBallsTest, OfADocumentAreThoseOfItsGraph) {
  for (const Placement& placement : {Placement(), kTilted}) {
    for (const SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kSurface}) {
      const Thinned box = ThinnedBox(kind, placement);
      const Volume balls = BallsIn(box.object, BallsOf(box.document, placement));
      EXPECT_EQ(balls.SortedPoints(),
                BallsIn(box.object, BallsOf(box.result.graph)).SortedPoints());
      EXPECT_GT(balls.PointCount(), 0u);
    }
  }
}

TEST(SheetSurfaceTest, OfASurfaceSkeletonHasItsPointsAsVertices) {
  const Thinned box = ThinnedBox(SkeletonKind::kSurface, kTilted);
  const SheetSurface sheets = SheetSurfaceOf(box.document);
  EXPECT_GT(sheets.vertices.size(), box.result.skeleton_points / 2);
  EXPECT_LE(sheets.vertices.size(), box.result.skeleton_points);
  EXPECT_EQ(sheets.radii.size(), sheets.vertices.size());
  EXPECT_GT(sheets.triangles.size(), sheets.vertices.size());
  for (const SurfaceTriangle& triangle : sheets.triangles) {
    EXPECT_LT(std::ranges::max(triangle), sheets.vertices.size());
  }
}

TEST(SheetSurfaceTest, NoTriangleJoinsTwoLabels) {
  ResultDocument document = ThinnedBox(SkeletonKind::kSurface).document;
  const size_t whole = SheetSurfaceOf(document).triangles.size();
  ResultDocument::Labels& labels = document.labels.emplace();
  labels.names = {3, 7};
  labels.of_nodes.assign(document.nodes.size(), 0);
  for (const WorldPoint& p : document.sheets.points) labels.of_sheets.push_back(p[0] > 15 ? 1 : 0);
  const SheetSurface sheets = SheetSurfaceOf(document);
  ASSERT_EQ(sheets.labels.size(), sheets.vertices.size());
  EXPECT_LT(sheets.triangles.size(), whole);
  EXPECT_GT(sheets.triangles.size(), 0.8 * static_cast<double>(whole));
  for (const auto& [a, b, c] : sheets.triangles) {
    EXPECT_EQ(sheets.labels[a], sheets.labels[b]);
    EXPECT_EQ(sheets.labels[a], sheets.labels[c]);
  }
  EXPECT_GT(std::ranges::count(sheets.labels, 0u), 0);
  EXPECT_GT(std::ranges::count(sheets.labels, 1u), 0);
}

TEST(SheetSurfaceTest, OfACurveSkeletonIsEmpty) {
  EXPECT_TRUE(SheetSurfaceOf(ThinnedBox(SkeletonKind::kCurve).document).vertices.empty());
}

TEST(SheetSurfaceTest, AClosedSurfaceIsShownInACurveSkeleton) {
  const exporting::Sample hollow = exporting::SampleOf(Shape::kHollowBall);
  const auto document = ParseResultDocument(exporting::JsonText(hollow.result));
  EXPECT_GT(SheetSurfaceOf(*document).triangles.size(), 100u);
}

TEST(SheetSurfaceTest, ResultsThatKnowNoLatticeHaveNone) {
  ResultDocument document = ThinnedBox(SkeletonKind::kSurface).document;
  document.placement.reset();
  EXPECT_TRUE(SheetSurfaceOf(document).vertices.empty());
}

TEST(SheetSurfaceTest, ADamagedPlacementIsNoCrash) {
  ResultDocument document = ThinnedBox(SkeletonKind::kSurface).document;
  document.placement->direction = {};
  EXPECT_TRUE(SheetSurfaceOf(document).vertices.empty());
}

}  // namespace
}  // namespace bccskel::view
