#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <latch>
#include <string>
#include <thread>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::skeletonize_call {
namespace {

using test::Converse, test::DeclaredVolume, test::Declare, test::RequestsFor, test::SkeletonOf;

SkeletonizeResult ByTheLibrary(const Volume& volume) {
  return *Skeletonize(volume, {}, exec::Context());
}

void ExpectSame(const absl::StatusOr<SkeletonizeResult>& found, const SkeletonizeResult& expected) {
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_EQ(found->sha256, expected.sha256);
  EXPECT_EQ(found->graph, expected.graph);
  EXPECT_EQ(found->certificate, expected.certificate);
  EXPECT_EQ(found->object_points, expected.object_points);
  EXPECT_EQ(found->skeleton_points, expected.skeleton_points);
  EXPECT_EQ(found->last_shell, expected.last_shell);
}

TEST(SkeletonizeCall, GivesTheLibrarysResultOverTcp) {
  const auto server = test::StartServer();
  const auto replies = Converse(*server, RequestsFor(test::SmallTorusPlanes()));
  ExpectSame(SkeletonOf(replies), ByTheLibrary(test::SmallTorus()));
}

TEST(SkeletonizeCall, GivesTheLibrarysResultOverAUnixSocket) {
  const test::TemporaryFolder folder;
  server::ServerConfig config = test::SmallServer();
  config.listen = {"unix:" + folder / "server.sock"};
  const auto server = test::StartServer(config);
  EXPECT_EQ(server->addresses(), config.listen);
  const auto replies = Converse(*server, RequestsFor(test::SmallTorusPlanes()));
  ExpectSame(SkeletonOf(replies), ByTheLibrary(test::SmallTorus()));
}

TEST(SkeletonizeCall, EightCallersAtOnceEachGetTheLibrarysResult) {
  const auto server = test::StartServer();
  constexpr int kCallers = 8;
  std::latch together(kCallers);
  std::vector<std::jthread> callers;
  for (int n = 0; n < kCallers; ++n) {
    callers.emplace_back([&, n] {
      const Shape shape = kShapes[static_cast<size_t>(n)];
      const Volume volume = *GenerateShape(shape, {.points = 60'000, .seed = 7});
      const SkeletonizeResult expected = ByTheLibrary(volume);
      const DeclaredVolume declared = Declare(volume, VolumeEncoding::kBricks);
      const auto channel = test::ConnectTo(server->address());
      together.arrive_and_wait();
      for (int repeat = 0; repeat < 3; ++repeat) {
        ExpectSame(SkeletonOf(Converse(channel, RequestsFor(declared))), expected);
      }
    });
  }
  callers.clear();
  test::WaitUntilIdle(*server);
}

struct Form {
  const char* name;
  VolumeEncoding encoding;
  VolumeCompression compression;
  size_t chunk_bytes;
};
class EncodingTest : public testing::TestWithParam<Form> {};

TEST_P(EncodingTest, GivesTheSameSkeleton) {
  const auto server = test::StartServer();
  const DeclaredVolume volume =
      Declare(test::SmallTorus(), GetParam().encoding, GetParam().compression);
  const auto replies = Converse(*server, RequestsFor(volume, GetParam().chunk_bytes));
  ExpectSame(SkeletonOf(replies), ByTheLibrary(test::SmallTorus()));
}

INSTANTIATE_TEST_SUITE_P(
    SkeletonizeCall, EncodingTest,
    testing::Values(Form{"OpenExrPlain", VolumeEncoding::kOpenExr, VolumeCompression::kNone,
                         100'000},
                    Form{"OpenExrRle", VolumeEncoding::kOpenExr, VolumeCompression::kRle, 777},
                    Form{"OpenExrZip", VolumeEncoding::kOpenExr, VolumeCompression::kZip, 100'000},
                    Form{"Planes", VolumeEncoding::kRawPlanes, VolumeCompression::kNone, 1001},
                    Form{"PlanesZstd", VolumeEncoding::kRawPlanes, VolumeCompression::kZstd, 1001},
                    Form{"Bricks", VolumeEncoding::kBricks, VolumeCompression::kNone, 333},
                    Form{"BricksZstd", VolumeEncoding::kBricks, VolumeCompression::kZstd, 100'000}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(SkeletonizeCall, AnEmptyVolumeHasAnEmptySkeleton) {
  const auto server = test::StartServer();
  const Volume empty = *VolumeBuilder({8, 8, 8}).Build();
  const auto replies = Converse(*server, RequestsFor(Declare(empty, VolumeEncoding::kRawPlanes)));
  ExpectSame(SkeletonOf(replies), ByTheLibrary(empty));
}

TEST(SkeletonizeCall, RepliesComeInTheStatedOrder) {
  const auto server = test::StartServer();
  const Volume volume = *GenerateShape(Shape::kTree, {.points = 300'000});
  const auto replies = Converse(*server, RequestsFor(Declare(volume, VolumeEncoding::kBricks)));
  ASSERT_TRUE(replies.status.ok()) << replies.status;
  std::string order;
  int32_t shell = 0;
  for (const v1::SkeletonizeResponse& response : replies.responses) {
    order += response.has_accepted()         ? 'a'
             : response.has_shell_progress() ? 'p'
             : response.has_skeleton_chunk() ? 's'
             : response.has_summary()        ? 'e'
                                             : '?';
    if (!response.has_shell_progress()) continue;
    EXPECT_GT(response.shell_progress().shell(), shell);
    shell = response.shell_progress().shell();
  }
  EXPECT_THAT(order, testing::MatchesRegex("ap*s+e"));
  EXPECT_EQ(shell, replies.responses.back().summary().last_shell()) << "the newest is never lost";
}

TEST(SkeletonizeCall, AcceptedNamesTheJobAndTheChunkLimit) {
  const auto server = test::StartServer();
  const auto replies = Converse(*server, RequestsFor(test::SmallTorusPlanes()));
  ASSERT_FALSE(replies.responses.empty());
  const v1::SkeletonizeAccepted& accepted = replies.responses[0].accepted();
  EXPECT_THAT(accepted.job(), testing::StartsWith("jobs/"));
  EXPECT_FALSE(accepted.durable());
  EXPECT_EQ(accepted.max_chunk_bytes(), 1u << 20);
}

}  // namespace
}  // namespace bccskel::skeletonize_call
