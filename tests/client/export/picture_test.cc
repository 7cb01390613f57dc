#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "client/export/json.h"
#include "client/export/picture/caption.h"
#include "client/export/picture/curve_colors.h"
#include "client/export/picture/escape.h"
#include "client/export/picture/glass_image.h"
#include "client/export/picture/projection.h"
#include "client/export/picture/svg.h"
#include "client/export/subject_document.h"
#include "client/view/first_view.h"
#include "tests/client/export/sample_skeletons.h"

namespace bccskel::exporting {
namespace {

using testing::HasSubstr;
using testing::Not;

view::ResultDocument DocumentOf(const Sample& sample) {
  return *view::ParseResultDocument(JsonText(sample.result));
}

std::string SvgOf(const Sample& sample) {
  return *SvgText({sample.result, sample.object, "<bad & title>"}, DocumentOf(sample));
}

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

TEST(GlassImageTest, PaintsWhereTheObjectIsAndNothingElse) {
  view::DisplaySurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  surface.triangles = {{0, 1, 2}};
  const View front = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Projection projection(front, surface.vertices, {120, 80}, 0);
  const RgbImage image = *ImageOf(GlassOf(surface, projection), 60, 40, 2, {});
  const auto pixel = [&](size_t x, size_t y) { return image.pixels[60 * y + x]; };
  EXPECT_EQ(image.pixels.size(), 60 * 40);
  EXPECT_EQ(pixel(0, 0), 0xfff8fafc);
  EXPECT_EQ(pixel(48, 2), pixel(0, 0));  // above the diagonal
  EXPECT_NE(pixel(12, 38), pixel(0, 0));
}

TEST(ProjectionTest, FillsThePanelUpToTheMargin) {
  const std::vector<WorldPoint> points = {{0, 0, 0}, {4, 1, 0}, {4, 3, 9}};
  const View front = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Projection projection(front, points, {100, 100}, 10);
  EXPECT_DOUBLE_EQ(projection.Project(points[0]).x, 10);
  EXPECT_DOUBLE_EQ(projection.Project(points[1]).x, 90);
  EXPECT_DOUBLE_EQ(projection.Project(points[0]).y, 80);  // y runs down
  EXPECT_DOUBLE_EQ(projection.Project(points[2]).y, 20);
}

TEST(ProjectionTest, OnePointLandsInTheMiddle) {
  const std::vector<WorldPoint> points = {{5, 6, 7}};
  const View front = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const PanelPoint p = Projection(front, points, {100, 80}, 10).Project(points[0]);
  EXPECT_DOUBLE_EQ(p.x, 50);
  EXPECT_DOUBLE_EQ(p.y, 40);
}

TEST(CurveColorsTest, ColorsRunFromThinToThick) {
  EXPECT_EQ(RadiusColorIndex(1, {1, 5}), 0);
  EXPECT_EQ(RadiusColorIndex(5, {1, 5}), kRadiusColors - 1);
  EXPECT_EQ(RadiusColorIndex(3, {3, 3}), kRadiusColors / 2);
  EXPECT_EQ(RadiusColor(0), "#2e1065");
  EXPECT_EQ(RadiusColor(kRadiusColors - 1), "#f59e0b");
}

TEST(CurveColorsTest, NeighboringLabelsHaveDistantHues) {
  EXPECT_EQ(HexColor(LabelRgb(0)), "#b42222");
  EXPECT_EQ(HexColor(LabelRgb(1)), "#224db4");
  EXPECT_EQ(HexColor(LabelRgb(7)), "#28b422");
}

TEST(PictureTest, EveryKindOfSkeletonHasOneThatNamesItsTopologyAndNeedsNoNetwork) {
  for (const Sample& sample : Samples()) {
    const std::string svg = SvgOf(sample);
    EXPECT_THAT(svg, HasSubstr("&lt;bad &amp; title&gt;"));
    EXPECT_THAT(svg, HasSubstr(BettiPhrase(sample.result.certificate.skeleton)));
    EXPECT_THAT(svg, HasSubstr("(topology kept)"));
    EXPECT_THAT(svg, Not(HasSubstr("src=\"http")));
    EXPECT_THAT(svg, Not(HasSubstr("href=\"http")));
  }
}

TEST(PictureTest, StatesChangesBeforeThinningOnALineOfTheirOwnAndTheUnit) {
  const Sample sample = SampleOf(Shape::kTree);
  view::ResultDocument document = DocumentOf(sample);
  document.certificate.unprepared = {1, 7, 0};
  document.unit = "um";
  const std::string svg = *SvgText({sample.result, sample.object, "title"}, document);
  EXPECT_THAT(svg, HasSubstr("y=\"76\">topology of the prepared object kept, preparing changed "
                             "loops 7 -&gt; 0</text>"));
  EXPECT_THAT(svg, HasSubstr(" \u00b5m</text>"));
  EXPECT_EQ(UnitBehind(DocumentOf(sample)), "");
}

// Rows of branches, each along x.
view::ResultDocument Comb(size_t branches, size_t points) {
  view::ResultDocument document = DocumentOf(SampleOf(Shape::kTree));
  document.nodes = {{.kind = "end", .position = {0, 0, 0}, .radius = 1}};
  document.edges.clear();
  document.points.clear();
  for (size_t n = 0; n < branches; ++n) {
    document.edges.push_back(
        {.source = 0, .target = 0, .first_point = n * points, .point_count = points, .length = 1});
    for (size_t p = 0; p < points; ++p) {
      document.points.push_back({static_cast<double>(p), static_cast<double>(n), 0});
    }
  }
  document.radii.assign(document.points.size(), 1);
  document.curves = document.points;
  return document;
}

TEST(PictureTest, ManyCurvesArePartOfItsImages) {
  const std::string title = "comb";
  const view::DisplaySurface no_object;
  const std::string few = *SvgText({title, Comb(1'000, 10), no_object});
  const std::string many = *SvgText({title, Comb(30'000, 10), no_object});
  EXPECT_THAT(few, HasSubstr("<path class=\"h\""));
  EXPECT_THAT(many, Not(HasSubstr("<path class=\"h\"")));
  EXPECT_LT(many.size(), 4'000'000);
}

TEST(PictureTest, WithoutAnObjectShowsTheWholeCurves) {
  const std::string title = "tree";
  const view::DisplaySurface no_object;
  const view::ResultDocument document = DocumentOf(SampleOf(Shape::kTree));
  const std::string svg = *SvgText({title, document, no_object});
  EXPECT_THAT(svg, HasSubstr("skeleton: " + Counted(document.edges.size(), "branch", "branches")));
  const std::vector<WorldPoint> shown = view::ShownPoints(document, {});
  for (const WorldPoint& p : document.points) EXPECT_GT(std::ranges::count(shown, p), 0);
}

TEST(SubjectDocumentTest, DrawsThePictureOfTheOneReadFromTheText) {
  const Sample sample = SampleOf(Shape::kTree);
  const Subject subject = {sample.result, sample.object, "x"};
  EXPECT_EQ(*SvgText(subject, *exporting::DocumentOf(subject)),
            *SvgText(subject, DocumentOf(sample)));
}

TEST(SubjectDocumentTest, EqualsTheOneReadFromTheText) {
  for (const Sample& sample : Samples()) {
    const view::ResultDocument read = DocumentOf(sample);
    const view::ResultDocument made = *exporting::DocumentOf({sample.result, sample.object, "x"});
    EXPECT_EQ(made.options, read.options);
    EXPECT_EQ(made.object_points, read.object_points);
    ASSERT_EQ(made.edges.size(), read.edges.size());
    for (size_t n = 0; n < read.edges.size(); ++n) {
      EXPECT_EQ(made.edges[n].first_point, read.edges[n].first_point);
      EXPECT_EQ(made.edges[n].point_count, read.edges[n].point_count);
      EXPECT_EQ(made.edges[n].length, read.edges[n].length);
      EXPECT_EQ(made.edges[n].pruning_level, read.edges[n].pruning_level);
    }
    EXPECT_EQ(made.points, read.points);
    EXPECT_EQ(made.radii, read.radii);
    EXPECT_EQ(made.births, read.births);
    EXPECT_EQ(made.shifts, read.shifts);
    EXPECT_EQ(made.curves, read.curves);
    EXPECT_EQ(made.sheets.points, read.sheets.points);
    EXPECT_EQ(made.sheets.radii, read.sheets.radii);
    EXPECT_EQ(made.sheets.births, read.sheets.births);
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
  EXPECT_EQ(DotsOf(SvgOf(box)), 3 * box.result.graph.sheets.size());
}

TEST(PictureTest, AnEmptyObjectHasOneWithoutALegend) {
  const std::string svg = SvgOf({});
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, Not(HasSubstr("radius ")));
  EXPECT_THAT(svg, Not(HasSubstr("junction")));
}

}  // namespace
}  // namespace bccskel::exporting
