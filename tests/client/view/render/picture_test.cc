#include "client/view/render/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <vector>

#include "client/export/json.h"
#include "tests/client/export/sample_skeletons.h"
#include "tests/support/contexts.h"

namespace bccskel::view {
namespace {

using ::testing::StartsWith;

absl::StatusOr<std::string> PictureOf(const exporting::Sample& sample,
                                      const PictureOptions& options, const exec::Context& context) {
  const auto result = ParseResultDocument(exporting::JsonText(sample.result));
  const auto surface = MakeDisplaySurface(sample.object, 10000, {});
  return RenderPng(*result, *surface, options, context);
}

PictureOptions Small(double turn = 30) {
  return {.width = 240, .height = 200, .turn = turn, .climb = 15, .title = "a title"};
}

TEST(PictureTest, EveryKindOfObjectGivesAPicture) {
  for (const exporting::Sample& sample : exporting::Samples()) {
    const auto png = PictureOf(sample, Small(), {});
    ASSERT_TRUE(png.ok()) << png.status();
    EXPECT_THAT(*png, StartsWith("\x89PNG\r\n\x1a\n"));
    EXPECT_GT(png->size(), 5000u);  // an empty one has 3000
  }
}

TEST(PictureTest, NothingGivesAPictureOfNothing) {
  const exporting::Sample nothing = {VolumeOfPoints({}), {}};
  EXPECT_TRUE(PictureOf(nothing, Small(), {}).ok());
}

TEST(PictureTest, IsTheSameForAnyNumberOfThreadsAndAnotherFromAnotherSide) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTree);
  test::TeamContext context(3);
  const std::string picture = *PictureOf(sample, Small(), {});
  EXPECT_EQ(*PictureOf(sample, Small(), context), picture);
  EXPECT_NE(*PictureOf(sample, Small(90), {}), picture);
}

TEST(PictureTest, CurvesThatAreLongTogetherAreDrawnThinner) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  const auto surface = *MakeDisplaySurface(sample.object, 10000, {});
  const auto with_length = [&](double factor) {
    ResultDocument result = *ParseResultDocument(exporting::JsonText(sample.result));
    for (ResultDocument::Edge& edge : result.edges) edge.length *= factor;
    return *RenderPng(result, surface, Small(), {});
  };
  EXPECT_EQ(with_length(1), with_length(0.5));
  EXPECT_NE(with_length(1), with_length(20));
  EXPECT_EQ(with_length(1000), with_length(10000));  // there is a limit
}

TEST(PictureTest, LengthsThatAFileStatesWronglyDoNotMatter) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  const auto surface = *MakeDisplaySurface(sample.object, 10000, {});
  for (const double length : {-1e18, 1e18}) {
    ResultDocument result = *ParseResultDocument(exporting::JsonText(sample.result));
    for (ResultDocument::Edge& edge : result.edges) edge.length = length;
    EXPECT_TRUE(RenderPng(result, surface, Small(), {}).ok());
  }
}

TEST(PictureTest, ATitleThatIsNotUtf8IsLeftOut) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  PictureOptions without = Small(), broken = Small();
  without.title = "";
  broken.title = "\xff\xfe";
  EXPECT_EQ(*PictureOf(sample, broken, {}), *PictureOf(sample, without, {}));
  EXPECT_NE(*PictureOf(sample, Small(), {}), *PictureOf(sample, without, {}));
}

// Pixels of a picture, row by row.
struct Pixels {
  int width;
  std::vector<uint32_t> values;

  uint32_t At(int x, int y) const { return values[static_cast<size_t>(y * width + x)]; }
};

Pixels Decoded(const std::string& png) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  png_image_begin_read_from_memory(&image, png.data(), png.size());
  image.format = PNG_FORMAT_RGBA;
  Pixels pixels = {static_cast<int>(image.width), {}};
  pixels.values.resize(size_t{image.width} * image.height);
  png_image_finish_read(&image, nullptr, pixels.values.data(), 0, nullptr);
  return pixels;
}

TEST(PictureTest, NoWordIsCutOff) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  for (const int width : {160, 400, 1000}) {
    PictureOptions options = Small();
    options.width = width;
    options.title = "a file with a rather long name, as they come out of pipelines.off";
    const Pixels picture = Decoded(*PictureOf(sample, options, {}));
    constexpr int kRowsOfWords = 66, kMargin = 8;
    for (int y = 0; y < kRowsOfWords; ++y) {
      for (int x = width - kMargin; x < width; ++x) {
        ASSERT_EQ(picture.At(x, y), picture.At(0, 0)) << width << ": " << x << ", " << y;
      }
    }
  }
}

TEST(PictureTest, LongWordsTakeAThirdLineInsteadOfASmallerFont) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  const auto surface = *MakeDisplaySurface(sample.object, 10000, {});
  PictureOptions options = Small();
  options.width = options.height = 400;
  // In the left corner, where the third line begins and no object is.
  const auto pixels_of_third_line = [&](const ResultDocument& result) {
    const Pixels picture = Decoded(*RenderPng(result, surface, options, {}));
    int count = 0;
    for (int y = 68; y < 76; ++y) {
      for (int x = 17; x < 60; ++x) count += picture.At(x, y) == picture.At(1, 1) ? 0 : 1;
    }
    return count;
  };
  ResultDocument result = *ParseResultDocument(exporting::JsonText(sample.result));
  EXPECT_EQ(pixels_of_third_line(result), 0);
  result.certificate.unprepared = {12, 34, 56};
  EXPECT_GT(pixels_of_third_line(result), 50);
}

TEST(PictureTest, TheLegendHasEveryColorOfNodes) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  const auto surface = *MakeDisplaySurface(sample.object, 10000, {});
  PictureOptions options = Small();
  options.width = 600;
  const auto legend_with = [&](const char* kind) {
    ResultDocument result = *ParseResultDocument(exporting::JsonText(sample.result));
    result.nodes.front().kind = kind;
    const Pixels picture = Decoded(*RenderPng(result, surface, options, {}));
    constexpr int kRowsOfLegend = 20;
    return std::vector<uint32_t>(picture.values.end() - kRowsOfLegend * options.width,
                                 picture.values.end());
  };
  const auto loop = legend_with("loop");
  EXPECT_NE(legend_with("end"), loop);
  EXPECT_NE(legend_with("isolated"), loop);
  EXPECT_NE(legend_with("closed_surface"), loop);
}

TEST(PictureTest, NothingHasNoLegend) {
  const exporting::Sample nothing = {VolumeOfPoints({}), {}};
  const Pixels picture = Decoded(*PictureOf(nothing, Small(), {}));
  constexpr int kRowsOfLegend = 20;
  const std::vector<uint32_t> legend(picture.values.end() - kRowsOfLegend * picture.width,
                                     picture.values.end());
  EXPECT_THAT(legend, testing::Each(picture.At(0, 0)));
}

TEST(PictureTest, StopsWhenItIsToldTo) {
  const exec::Context context = test::Stopped();
  const auto picture = PictureOf(exporting::SampleOf(Shape::kTorus), Small(), context);
  EXPECT_EQ(picture.status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel::view
