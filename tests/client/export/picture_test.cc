#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "client/export/picture/caption.h"
#include "client/export/picture/display_curve.h"
#include "client/export/picture/escape.h"
#include "client/export/picture/png.h"
#include "client/export/picture/projection.h"
#include "client/export/picture/surface_image.h"
#include "client/export/picture/surface_points.h"
#include "client/export/picture/svg.h"
#include "tests/client/export/sample_skeletons.h"

namespace bccskel::exporting {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CaptionTest, GroupsDigitsAndCountsInEnglish) {
  EXPECT_EQ(GroupedDigits(0), "0");
  EXPECT_EQ(GroupedDigits(999), "999");
  EXPECT_EQ(GroupedDigits(1234567), "1,234,567");
  EXPECT_EQ(BettiPhrase({1, 2, 1}), "1 component, 2 loops, 1 cavity");
}

TEST(CaptionTest, EscapesWhatMarkupWouldTakeForItsOwn) {
  EXPECT_EQ(EscapeMarkup("<a href=\"x\">&\n"), "&lt;a href=&quot;x&quot;&gt;&amp; ");
  EXPECT_EQ(EscapeMarkup("\xc2\xb5m \xb5m"), "\xc2\xb5m \xef\xbf\xbdm");
}

TEST(PngTest, EveryChunkHasItsChecksum) {
  const std::string png = *EncodePng({2, 1, {1, 2, 3, 4, 5, 6, 7, 8}});
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    for (size_t n = 0; n < 4; ++n) value = value << 8 | static_cast<uint8_t>(png[at + n]);
    return value;
  };
  size_t at = 8, chunks = 0;
  for (; at < png.size(); ++chunks) {
    const uint32_t length = word(at);
    const auto* body = reinterpret_cast<const Bytef*>(png.data() + at + 4);
    EXPECT_EQ(crc32(0, body, length + 4), word(at + 8 + length));
    at += 12 + length;
  }
  EXPECT_EQ(at, png.size());
  EXPECT_EQ(chunks, 3);
}

TEST(SurfacePointsTest, AreThePointsThatLackAD6Neighbor) {
  const Volume object = *GenerateShape(Shape::kTorus, {.points = 20000});
  std::vector<LatticePoint> expected;
  object.ForEachPoint([&](LatticePoint p) {
    for (const LatticePoint d : {LatticePoint{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}) {
      if (object.Contains(p + d) && object.Contains(p - d)) continue;
      expected.push_back(p);
      return;
    }
  });
  EXPECT_EQ(SurfacePoints(object), expected);
}

TEST(SurfaceImageTest, PaintsWhereThePointsAreAndNothingElse) {
  const std::vector<PanelPoint> points = {{20, 20, 0}};
  const RgbaImage image = RenderSurface(points, 5, 60, 40);
  const auto opacity = [&](size_t x, size_t y) { return image.pixels[4 * (60 * y + x) + 3]; };
  EXPECT_GT(opacity(20, 20), 0);
  EXPECT_EQ(opacity(50, 30), 0);
  EXPECT_EQ(image.pixels.size(), 4 * 60 * 40);
}

// A line seen from its end: half a million pixels for each of its points. Rounding moves them.
TEST(SurfaceImageTest, LaysOnlyTheNearestOfPointsBehindEachOther) {
  std::vector<PanelPoint> line;
  for (int n = 0; n < 75512; ++n) {
    const double rounding = 1e-9 * (n % 7);
    line.push_back({300 + 200.0 * (n % 2) + rounding, 200 - rounding, 100.0 * ((n * 31) % 75512)});
  }
  const std::vector<PanelPoint> nearest = NearestOfEachPlace(line);
  ASSERT_EQ(nearest.size(), 2u);
  for (const PanelPoint& p : nearest) EXPECT_GT(p.depth, 100.0 * (75512 - 3));
  const std::vector<PanelPoint> few(line.begin(), line.begin() + 60);
  const std::vector<PanelPoint> seen = NearestOfEachPlace(few);
  // No middle of a pixel lies on the rim, where rounding decides.
  EXPECT_EQ(RenderSurface(few, 99.7, 600, 400).pixels, RenderSurface(seen, 99.7, 600, 400).pixels);
}

TEST(ProjectionTest, FillsThePanelUpToTheMargin) {
  const std::vector<WorldPoint> points = {{0, 0, 0}, {4, 1, 0}, {4, 3, 9}};
  const View front = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Projection projection(front, {points, 0.0}, {100, 100}, 10);
  EXPECT_DOUBLE_EQ(projection.Project(points[0]).x, 10);
  EXPECT_DOUBLE_EQ(projection.Project(points[1]).x, 90);
  EXPECT_DOUBLE_EQ(projection.Project(points[0]).y, 80);  // y runs down
  EXPECT_DOUBLE_EQ(projection.Project(points[2]).y, 20);
}

TEST(ProjectionTest, OnePointLandsInTheMiddle) {
  const std::vector<WorldPoint> points = {{5, 6, 7}};
  const View front = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const PanelPoint p = Projection(front, {points, 1.0}, {100, 80}, 10).Project(points[0]);
  EXPECT_DOUBLE_EQ(p.x, 50);
  EXPECT_DOUBLE_EQ(p.y, 40);
}

TEST(DisplayCurveTest, SmoothingLeavesTheEndsWhereTheyAre) {
  const SkeletonGraph graph = SampleOf(Shape::kTree).result.graph;
  const std::vector<DisplayCurve> curves = DisplayCurvesOf(graph);
  ASSERT_EQ(curves.size(), graph.edges.size());
  for (size_t n = 0; n < curves.size(); ++n) {
    const auto points = graph.PointsOf(graph.edges[n]);
    ASSERT_EQ(curves[n].points.size(), points.size());
    EXPECT_EQ(curves[n].points.front(), graph.PositionOf(points.front()));
    EXPECT_EQ(curves[n].points.back(), graph.PositionOf(points.back()));
  }
}

TEST(DisplayCurveTest, ColorsRunFromThinToThick) {
  EXPECT_EQ(RadiusColorIndex(1, {1, 5}), 0);
  EXPECT_EQ(RadiusColorIndex(5, {1, 5}), kRadiusColors - 1);
  EXPECT_EQ(RadiusColorIndex(3, {3, 3}), kRadiusColors / 2);
  EXPECT_EQ(RadiusColor(0), "#2e1065");
  EXPECT_EQ(RadiusColor(kRadiusColors - 1), "#f59e0b");
}

TEST(PictureTest, EveryKindOfSkeletonHasOneThatNamesItsTopologyAndNeedsNoNetwork) {
  for (const Sample& sample : Samples()) {
    const Subject subject = {sample.result, sample.object, "<bad & title>"};
    const std::string svg = *SvgText(subject);
    EXPECT_THAT(svg, HasSubstr("&lt;bad &amp; title&gt;"));
    EXPECT_THAT(svg, HasSubstr(BettiPhrase(sample.result.certificate.skeleton)));
    EXPECT_THAT(svg, HasSubstr("(topology kept)"));
    EXPECT_THAT(svg, Not(HasSubstr("src=\"http")));
    EXPECT_THAT(svg, Not(HasSubstr("href=\"http")));
  }
}

// A dot is a line without length.
size_t DotsOf(const std::string& svg) {
  size_t count = 0;
  for (const std::string& line : LinesOf(svg)) {
    if (!line.starts_with("<path stroke")) continue;
    for (size_t at = line.find("h0"); at != std::string::npos; at = line.find("h0", at + 1)) {
      ++count;
    }
  }
  return count;
}

TEST(PictureTest, ShowsEveryPointOfSheetsInEveryView) {
  Sample box = SampleOf(Shape::kBox);
  SkeletonizeOptions options;
  options.thinning.kind = SkeletonKind::kSurface;
  box.result = *Skeletonize(box.object, options, {});
  ASSERT_GT(box.result.graph.sheets.size(), 20u);
  EXPECT_EQ(DotsOf(*SvgText({box.result, box.object, ""})), 3 * box.result.graph.sheets.size());
}

TEST(PictureTest, AnEmptyObjectHasOne) {
  const Sample sample;
  EXPECT_THAT(*SvgText({sample.result, sample.object, ""}), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace bccskel::exporting
