#include "server/calls/skeleton_responses.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/server/support/declared_volume.h"

namespace bccskel::server {
namespace {

v1::ShellProgress Progress(int shell) {
  v1::ShellProgress progress;
  progress.set_shell(shell);
  return progress;
}

JobResult TorusResult(size_t thin_volume_bytes) {
  JobResult result;
  result.skeleton = *Skeletonize(test::SmallTorus(), {}, exec::Context());
  result.thin_volume = std::string(thin_volume_bytes, 't');
  return result;
}

TEST(SkeletonResponses, IsEmptyAtFirst) {
  SkeletonResponses responses;
  EXPECT_FALSE(responses.Next().has_value());
  EXPECT_FALSE(responses.AtEnd());
}

TEST(SkeletonResponses, KeepsOfTheProgressOnlyTheLatest) {
  SkeletonResponses responses;
  responses.Accept("jobs/1");
  for (int shell = 1; shell <= 1000; ++shell) responses.Report(Progress(shell));
  EXPECT_EQ(responses.Next()->accepted().job(), "jobs/1");
  EXPECT_EQ(responses.Next()->shell_progress().shell(), 1000);
  EXPECT_FALSE(responses.Next().has_value());
}

TEST(SkeletonResponses, KeepsAllPointsOfShellsAndSendsThemBeforeTheResult) {
  SkeletonResponses responses;
  v1::ShellPoints points;
  for (int shell = 1; shell <= 3; ++shell) {
    points.set_shell(shell);
    responses.AddShellPoints(points.SerializeAsString());
  }
  responses.Complete(TorusResult(0));
  for (int shell = 1; shell <= 3; ++shell)
    EXPECT_EQ(responses.Next()->shell_points().shell(), shell);
  EXPECT_TRUE(responses.Next()->has_skeleton_chunk());
}

TEST(SkeletonResponses, CutsTheResultOnePieceAtATime) {
  constexpr size_t kThinBytes = 600'000, kMaxPiece = 256 * 1024;
  SkeletonResponses responses;
  responses.Report(Progress(9));
  responses.Complete(TorusResult(kThinBytes));
  EXPECT_TRUE(responses.Next()->has_shell_progress()) << "the last news are not lost";
  size_t thin_bytes = 0;
  std::string order;
  while (auto response = responses.Next()) {
    EXPECT_LE(response->ByteSizeLong(), kMaxPiece + 100);
    order += response->has_skeleton_chunk() ? 's' : response->has_summary() ? 'e' : 't';
    if (!response->has_thin_volume_chunk()) continue;
    EXPECT_EQ(response->thin_volume_chunk().offset(), thin_bytes);
    thin_bytes += response->thin_volume_chunk().data().size();
  }
  EXPECT_EQ(order, "sttte");
  EXPECT_EQ(thin_bytes, kThinBytes);
  EXPECT_TRUE(responses.AtEnd());
}

TEST(SkeletonResponses, StoredPiecesAreTheSameOnTheWire) {
  JobResult result = TorusResult(300'000);
  ResultPieces pieces(result);
  int count = 0;
  while (const auto piece = pieces.Next()) {
    v1::SkeletonizeResponse stored;
    ASSERT_TRUE(SetPiece(RecordOf(*piece), stored).ok());
    EXPECT_EQ(stored.SerializeAsString(), piece->SerializeAsString());
    EXPECT_FALSE(stored.has_skeleton_chunk() || stored.has_thin_volume_chunk()) << "was parsed";
    ++count;
  }
  EXPECT_EQ(count, 4);
}

// A write that waits for another one that does not come would never be sent.
TEST(SkeletonResponses, HasMoreExactlyWhenTheNextResponseIsThere) {
  SkeletonResponses responses;
  const auto expect_truth = [&](int count) {
    for (int n = 0; n < count; ++n) {
      EXPECT_TRUE(responses.HasMore());
      ASSERT_TRUE(responses.Next().has_value());
    }
    EXPECT_FALSE(responses.HasMore());
    EXPECT_FALSE(responses.Next().has_value());
  };
  expect_truth(0);
  responses.Accept("jobs/1");
  responses.Report(Progress(1));
  expect_truth(2);
  responses.AddShellPoints(v1::ShellPoints().SerializeAsString());
  expect_truth(1);
  responses.Report(Progress(9));
  responses.Complete(TorusResult(600'000));
  expect_truth(6);
}

}  // namespace
}  // namespace bccskel::server
