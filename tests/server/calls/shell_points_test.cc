#include "proto/wire/shell_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

namespace bccskel {
namespace {

using test::Converse, test::Declare, test::RawCall, test::RequestsFor, test::SkeletonOf;

std::vector<v1::SkeletonizeRequest> PeelRequests(const Volume& volume) {
  std::vector<v1::SkeletonizeRequest> requests =
      RequestsFor(Declare(volume, VolumeEncoding::kBricks));
  requests.front().mutable_config()->set_shell_points_return(v1::SHELL_POINTS_RETURN_ALL);
  requests.front().mutable_config()->mutable_options()->set_tip_placement(
      v1::TIP_PLACEMENT_AS_THINNED);
  return requests;
}

// The points of all messages, and that these keep to the order.
std::vector<LatticePoint> PointsOf(const test::Replies& replies) {
  std::vector<LatticePoint> all;
  int32_t shell = 1;
  bool result_began = false;
  for (const v1::SkeletonizeResponse& response : replies.responses) {
    result_began = result_began || response.has_skeleton_chunk();
    if (!response.has_shell_points()) continue;
    EXPECT_FALSE(result_began);
    EXPECT_GE(response.shell_points().shell(), shell);
    shell = response.shell_points().shell();
    const auto points = wire::PointsOf(response.shell_points());
    EXPECT_TRUE(points.ok()) << points.status();
    if (points.ok()) all.insert(all.end(), points->begin(), points->end());
  }
  return all;
}

void ExpectTheObject(const test::Replies& replies, const Volume& object) {
  ASSERT_TRUE(replies.status.ok()) << replies.status;
  const auto skeleton = SkeletonOf(replies);
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  std::vector<LatticePoint> all = PointsOf(replies);
  EXPECT_EQ(all.size() + skeleton->skeleton_points, object.PointCount());
  SkeletonizeOptions options;
  options.pruning.tips = TipPlacement::kAsThinned;
  const Volume thin = Skeletonize(object, options, {})->thin;
  for (LatticePoint p : thin.SortedPoints()) all.push_back(p);
  std::ranges::sort(all);
  EXPECT_EQ(all, object.SortedPoints());
}

TEST(ShellPointsCall, SendsEveryPointOfTheObjectOnce) {
  const auto server = test::StartServer();
  for (Shape shape : {Shape::kTree, Shape::kHollowBall}) {
    const Volume object = *GenerateShape(shape, {.points = 60'000, .noise = 0.05});
    ExpectTheObject(Converse(*server, PeelRequests(object)), object);
  }
}

TEST(ShellPointsCall, SendsNoneWhereNoneAreWanted) {
  const auto server = test::StartServer();
  const auto replies = Converse(*server, RequestsFor(test::SmallTorusPlanes()));
  ASSERT_TRUE(replies.status.ok());
  for (const auto& response : replies.responses) EXPECT_FALSE(response.has_shell_points());
}

// The points of this ball do not fit what gRPC takes from a server whose caller does not read.
TEST(ShellPointsCall, ASlowReaderHoldsUpNobodyAndLosesNothing) {
  server::ServerConfig config = test::SmallServer();
  config.limits.threads = 1;
  const auto server = test::StartServer(config);
  const Volume object = *GenerateShape(Shape::kBall, {.points = 1'000'000});
  RawCall slow(test::ConnectTo(server->address()));
  for (const v1::SkeletonizeRequest& request : PeelRequests(object)) {
    ASSERT_TRUE(slow.Send(request));
  }
  for (int n = 0; n < 3; ++n) {
    const auto other = Converse(*server, RequestsFor(test::SmallTorusPlanes()));
    EXPECT_TRUE(other.status.ok()) << other.status;
  }
  test::Replies replies;
  while (auto response = slow.Receive()) replies.responses.push_back(*std::move(response));
  replies.status = slow.Finish();
  ExpectTheObject(replies, object);
  test::WaitUntilIdle(*server);  // which means that all memory is given back
}

TEST(ShellPointsCall, RefusesAChoiceThatItDoesNotKnow) {
  const auto server = test::StartServer();
  auto requests = PeelRequests(test::SmallTorus());
  requests.front().mutable_config()->set_shell_points_return(static_cast<v1::ShellPointsReturn>(9));
  const auto replies = Converse(*server, requests);
  EXPECT_TRUE(absl::IsInvalidArgument(replies.status)) << replies.status;
}

}  // namespace
}  // namespace bccskel
