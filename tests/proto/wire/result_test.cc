#include "proto/wire/result.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace bccskel::wire {
namespace {

using std::chrono::nanoseconds;

SkeletonizeResult SomeResult() {
  SkeletonizeResult result;
  result.graph.placement.spacing = {0.5, 0.5, 2};
  result.certificate = {.mask = BettiNumbers{1, 3, 5},
                        .unprepared = BettiNumbers{1, 3, 5},
                        .input = {1, 3, 2},
                        .skeleton = {1, 3, 2},
                        .simple_points_left = 4};
  result.timings = {.preparing = nanoseconds(7),
                    .distance = nanoseconds(1'500'000'000),
                    .shells = nanoseconds(1),
                    .thinning = nanoseconds(2),
                    .cleanup = nanoseconds(3),
                    .pruning = nanoseconds(9),
                    .certificate = nanoseconds(4),
                    .graph = nanoseconds(5),
                    .total = nanoseconds(1'500'000'015)};
  result.options.preparing = {.denoise_passes = 2, .cavities = CavityFilling::kOn};
  result.options.pruning = {PruningRule::kLength, 2.5, TipPlacement::kAsThinned};
  result.options.distance = DistanceKind::kEuclidean;
  result.preparing = {{PreparingStepKind::kDenoise, 2, 30, 40},
                      {PreparingStepKind::kFillCavities, 3, 50, 0},
                      {PreparingStepKind::kDropSmallComponents, 4, 0, 60},
                      {PreparingStepKind::kKeepLargestComponent, 5, 0, 70}};
  result.object_points = uint64_t{1} << 40;
  result.skeleton_points = 321;
  result.last_shell = 17;
  result.sha256 = std::string(62, 'a') + "0f";
  return result;
}

TEST(ResultRoundTrip, KeepsTheSummary) {
  const SkeletonizeResult result = SomeResult();
  const auto back = FromMessage(SummaryOf(result, {}));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->certificate, result.certificate);
  EXPECT_EQ(back->graph.placement, result.graph.placement);
  EXPECT_EQ(back->timings, result.timings);
  EXPECT_EQ(back->preparing, result.preparing);
  EXPECT_EQ(back->options.preparing, result.options.preparing);
  EXPECT_EQ(back->options.pruning, result.options.pruning);
  EXPECT_EQ(back->options.distance, result.options.distance);
  EXPECT_EQ(back->object_points, result.object_points);
  EXPECT_EQ(back->skeleton_points, result.skeleton_points);
  EXPECT_EQ(back->last_shell, result.last_shell);
  EXPECT_EQ(back->sha256, result.sha256);
}

TEST(ResultRoundTrip, KeepsWhatOnlyTheJobKnows) {
  const JobFacts facts = {.queued = nanoseconds(5),
                          .decoded = nanoseconds(6'000'000'007),
                          .threads = 3,
                          .thin_volume_size_bytes = 8,
                          .algorithm_version = "9",
                          .method = "thinning"};
  EXPECT_EQ(FactsOf(SummaryOf(SomeResult(), facts)), facts);
}

TEST(ResultRoundTrip, KeepsProgress) {
  const exec::ShellProgress progress = {
      .shell = 2, .last_shell = 9, .points = 100, .removed = 80, .remaining = 20};
  const v1::ShellProgress message = ToMessage(progress, nanoseconds(1'000'000'001));
  const exec::ShellProgress back = FromMessage(message);
  EXPECT_EQ(back.shell, 2);
  EXPECT_EQ(back.last_shell, 9);
  EXPECT_EQ(back.points, 100u);
  EXPECT_EQ(back.removed, 80u);
  EXPECT_EQ(back.remaining, 20u);
  EXPECT_EQ(message.elapsed().seconds(), 1);
  EXPECT_EQ(message.elapsed().nanos(), 1);
}

TEST(Result, RefusesAStepOfAnUnknownKind) {
  v1::SkeletonSummary message = SummaryOf(SomeResult(), {});
  message.mutable_preparing(0)->set_kind(static_cast<v1::PreparingStepKind>(99));
  EXPECT_EQ(FromMessage(message).status().code(), absl::StatusCode::kDataLoss);
}

TEST(Result, RefusesAShortDigest) {
  v1::SkeletonSummary message = SummaryOf(SomeResult(), {});
  EXPECT_EQ(message.sha256().size(), 32u);
  message.set_sha256("short");
  EXPECT_EQ(FromMessage(message).status().code(), absl::StatusCode::kDataLoss);
}

}  // namespace
}  // namespace bccskel::wire
