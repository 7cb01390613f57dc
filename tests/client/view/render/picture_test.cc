#include "client/view/render/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stop_token>

#include "client/export/json.h"
#include "core/exec/worker_team.h"
#include "tests/client/export/sample_skeletons.h"

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
  exec::WorkerTeam team(3);
  exec::Context context;
  context.team = &team;
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

TEST(PictureTest, ATitleThatIsNotUtf8IsLeftOut) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  PictureOptions without = Small(), broken = Small();
  without.title = "";
  broken.title = "\xff\xfe";
  EXPECT_EQ(*PictureOf(sample, broken, {}), *PictureOf(sample, without, {}));
  EXPECT_NE(*PictureOf(sample, Small(), {}), *PictureOf(sample, without, {}));
}

TEST(PictureTest, StopsWhenItIsToldTo) {
  std::stop_source stop;
  stop.request_stop();
  exec::Context context;
  context.stop = stop.get_token();
  const auto picture = PictureOf(exporting::SampleOf(Shape::kTorus), Small(), context);
  EXPECT_EQ(picture.status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel::view
