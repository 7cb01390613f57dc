#include "server/calls/response_outbox.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

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

TEST(ResponseOutbox, IsEmptyAtFirst) {
  ResponseOutbox outbox;
  EXPECT_FALSE(outbox.Next().has_value());
  EXPECT_FALSE(outbox.AtEnd());
}

TEST(ResponseOutbox, KeepsOfTheProgressOnlyTheLatest) {
  ResponseOutbox outbox;
  outbox.Accept("jobs/1");
  for (int shell = 1; shell <= 1000; ++shell) outbox.Report(Progress(shell));
  EXPECT_EQ(outbox.Next()->accepted().job(), "jobs/1");
  EXPECT_EQ(outbox.Next()->shell_progress().shell(), 1000);
  EXPECT_FALSE(outbox.Next().has_value());
}

TEST(ResponseOutbox, KeepsAllPointsOfShellsAndSendsThemBeforeTheResult) {
  ResponseOutbox outbox;
  v1::ShellPoints points;
  for (int shell = 1; shell <= 3; ++shell) {
    points.set_shell(shell);
    outbox.Peel(points.SerializeAsString());
  }
  outbox.Complete(TorusResult(0));
  for (int shell = 1; shell <= 3; ++shell) EXPECT_EQ(outbox.Next()->shell_points().shell(), shell);
  EXPECT_TRUE(outbox.Next()->has_skeleton_chunk());
}

TEST(ResponseOutbox, CutsTheResultOnePieceAtATime) {
  constexpr size_t kThinBytes = 600'000, kMaxPiece = 256 * 1024;
  ResponseOutbox outbox;
  outbox.Report(Progress(9));
  outbox.Complete(TorusResult(kThinBytes));
  EXPECT_TRUE(outbox.Next()->has_shell_progress()) << "the last news are not lost";
  size_t thin_bytes = 0;
  std::string order;
  while (auto response = outbox.Next()) {
    EXPECT_LE(response->ByteSizeLong(), kMaxPiece + 100);
    order += response->has_skeleton_chunk() ? 's' : response->has_summary() ? 'e' : 't';
    if (!response->has_thin_volume_chunk()) continue;
    EXPECT_EQ(response->thin_volume_chunk().offset(), thin_bytes);
    thin_bytes += response->thin_volume_chunk().data().size();
  }
  EXPECT_EQ(order, "sttte");
  EXPECT_EQ(thin_bytes, kThinBytes);
  EXPECT_TRUE(outbox.AtEnd());
}

// A write that waits for another one that does not come would never be sent.
TEST(ResponseOutbox, HasMoreExactlyWhenTheNextResponseIsThere) {
  ResponseOutbox outbox;
  const auto expect_truth = [&](int responses) {
    for (int n = 0; n < responses; ++n) {
      EXPECT_TRUE(outbox.HasMore());
      ASSERT_TRUE(outbox.Next().has_value());
    }
    EXPECT_FALSE(outbox.HasMore());
    EXPECT_FALSE(outbox.Next().has_value());
  };
  expect_truth(0);
  outbox.Accept("jobs/1");
  outbox.Report(Progress(1));
  expect_truth(2);
  outbox.Peel(v1::ShellPoints().SerializeAsString());
  expect_truth(1);
  outbox.Report(Progress(9));
  outbox.Complete(TorusResult(600'000));
  expect_truth(6);
}

}  // namespace
}  // namespace bccskel::server
