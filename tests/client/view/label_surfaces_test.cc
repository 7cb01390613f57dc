#include "client/view/label_surfaces.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <vector>

#include "core/exec/worker_team.h"
#include "core/import/shapes/shapes.h"

namespace bccskel::view {
namespace {

const std::vector<uint64_t> kSizes = {5'000, 60'000, 15'000};

absl::StatusOr<std::shared_ptr<const Volume>> BallOf(size_t n) {
  return std::make_shared<const Volume>(*GenerateShape(Shape::kBall, {.points = kSizes[n]}));
}

TEST(LabelSurfacesTest, HoldsTheSurfacesInOrderForAnyNumberOfThreads) {
  const DisplaySurface one = *SurfacesOfLabels(kSizes, BallOf, 3000, {});
  ASSERT_EQ(one.triangles_of_labels.size(), 3u);
  EXPECT_EQ(one.triangles_of_labels[0] + one.triangles_of_labels[1] + one.triangles_of_labels[2],
            one.triangles.size());
  EXPECT_LE(one.triangles.size(), 3000u);
  EXPECT_GT(one.triangles_of_labels[1], one.triangles_of_labels[2]);
  EXPECT_GT(one.triangles_of_labels[2], one.triangles_of_labels[0]);
  // The first is small: no corner of its triangles belongs to another.
  uint32_t last = 0;
  for (size_t n = 0; n < one.triangles_of_labels[0]; ++n) {
    for (const uint32_t corner : one.triangles[n]) last = std::max(last, corner);
  }
  for (size_t n = one.triangles_of_labels[0]; n < one.triangles.size(); ++n) {
    for (const uint32_t corner : one.triangles[n]) EXPECT_GT(corner, last);
  }
  exec::WorkerTeam team(3);
  exec::Context context;
  context.team = &team;
  const DisplaySurface three = *SurfacesOfLabels(kSizes, BallOf, 3000, context);
  EXPECT_EQ(one.vertices, three.vertices);
  EXPECT_EQ(one.triangles, three.triangles);
}

TEST(LabelSurfacesTest, ManySmallLabelsStillHaveAFewTrianglesEach) {
  const std::vector<uint64_t> sizes(50, 5'000);
  const auto object = [](size_t) { return BallOf(0); };
  const DisplaySurface all = *SurfacesOfLabels(sizes, object, 10, {});
  for (const size_t triangles : all.triangles_of_labels) EXPECT_GE(triangles, 8u);
}

TEST(LabelSurfacesTest, AnErrorOfAnObjectEndsTheWork) {
  std::atomic<int> asked = 0;
  const auto object = [&](size_t n) -> absl::StatusOr<std::shared_ptr<const Volume>> {
    ++asked;
    if (n == 1) return absl::DataLossError("no object");
    return BallOf(0);
  };
  EXPECT_EQ(SurfacesOfLabels(std::vector<uint64_t>(50, 5'000), object, 1000, {}).status(),
            absl::DataLossError("no object"));
  EXPECT_EQ(asked, 2);
  std::stop_source stop;
  stop.request_stop();
  exec::Context stopped;
  stopped.stop = stop.get_token();
  EXPECT_EQ(SurfacesOfLabels(kSizes, BallOf, 3000, stopped).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel::view
