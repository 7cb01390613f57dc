#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/io/volume_decoder.h"
#include "proto/wire/options.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using test::Converse;

struct OptionsCase {
  const char* name;
  SkeletonizeOptions options;
  SkeletonizeOptions standard = {};  // what the options are held against
};
// Pruning makes up for what stubble policies leave behind.
constexpr PruningOptions kUnpruned = {PruningRule::kNone, 0, TipPlacement::kAsThinned};

class OptionsTest : public testing::TestWithParam<OptionsCase> {};

std::vector<LatticePoint> Blob() {
  return test::Translated(test::RandomBlob(6, {24, 24, 24}, 12, 10.0), {60, 0, 0});
}

// A cloud of thin parts beside a thick one: every option makes a difference.
const Volume& CloudAndBlob() {
  static const Volume object = [] {
    VolumeBuilder builder({80, 48, 48});
    for (const LatticePoint p : test::RandomCloud(5, {24, 24, 24}, 0.35)) builder.Add(p);
    for (const LatticePoint p : Blob()) builder.Add(p);
    return *std::move(builder).Build();
  }();
  return object;
}

TEST_P(OptionsTest, ReachesThePipeline) {
  const auto server = test::StartServer();
  auto requests = RequestsFor(test::Declare(CloudAndBlob(), VolumeEncoding::kBricks));
  *requests[0].mutable_config()->mutable_options() = wire::ToMessage(GetParam().options);
  const auto found = SkeletonOf(Converse(*server, requests));
  ASSERT_TRUE(found.ok()) << found.status();
  const auto expected = Skeletonize(CloudAndBlob(), GetParam().options, exec::Context());
  const auto standard = Skeletonize(CloudAndBlob(), GetParam().standard, exec::Context());
  EXPECT_EQ(found->sha256, expected->sha256);
  EXPECT_NE(found->sha256, standard->sha256) << "this case cannot tell whether the option arrives";
}

INSTANTIATE_TEST_SUITE_P(
    Skeletonize, OptionsTest,
    testing::Values(
        OptionsCase{"StubbleNone", {.thinning = {.stubble = StubblePolicy::kNone}}},
        OptionsCase{"StubbleLiteral",
                    {.thinning = {.stubble = StubblePolicy::kLiteral}, .pruning = kUnpruned},
                    {.pruning = kUnpruned}},
        OptionsCase{
            "CleanupOff",
            {.thinning = {.stubble = StubblePolicy::kNone, .cleanup = ThinnessCleanup::kOff}}},
        OptionsCase{"Directional", {.thinning = {.method = ThinningMethod::kDirectional}}},
        OptionsCase{"Alternating",
                    {.thinning = {.method = ThinningMethod::kDirectionalAlternating}}},
        OptionsCase{
            "Kernel",
            {.thinning = {.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kKernel}}},
        OptionsCase{"ShellWidth", {.thinning = {.shell_width = 2.5}}},
        OptionsCase{"Partial", {.thinning = {.last_shell = 3}}},
        OptionsCase{"Distance", {.distance = DistanceKind::kChamfer}},
        OptionsCase{"Pruning", {.pruning = {.rule = PruningRule::kNone}}},
        OptionsCase{"Tips", {.pruning = {.tips = TipPlacement::kAsThinned}}},
        OptionsCase{"Keep", {.thinning = {.keep = {Blob().front()}}}}),
    [](const auto& test) { return std::string(test.param.name); });

struct ThinCase {
  const char* name;
  v1::ThinVolumeReturn wanted;
  VolumeEncoding encoding;
};
class ThinVolumeTest : public testing::TestWithParam<ThinCase> {};

TEST_P(ThinVolumeTest, ComesBackWhole) {
  const auto server = test::StartServer();
  auto requests = RequestsFor(test::SmallTorusPlanes());
  requests[0].mutable_config()->set_thin_volume_return(GetParam().wanted);
  const auto replies = Converse(*server, requests);
  ASSERT_TRUE(replies.status.ok()) << replies.status;
  const std::string bytes = ThinVolumeOf(replies);
  EXPECT_EQ(replies.responses.back().summary().thin_volume_size_bytes(), bytes.size());
  const auto thin = DecodeVolume(GetParam().encoding, bytes);
  ASSERT_TRUE(thin.ok()) << thin.status();
  EXPECT_EQ(*thin, Skeletonize(test::SmallTorus(), {}, exec::Context())->thin);
}

INSTANTIATE_TEST_SUITE_P(
    Skeletonize, ThinVolumeTest,
    testing::Values(ThinCase{"OpenExr", v1::THIN_VOLUME_RETURN_OPENEXR, VolumeEncoding::kOpenExr},
                    ThinCase{"Bricks", v1::THIN_VOLUME_RETURN_BRICKS, VolumeEncoding::kBricks}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(SkeletonizeThreads, DoNotChangeTheResultAndAreReported) {
  const auto server = test::StartServer();
  const Volume volume = *GenerateShape(Shape::kKnot, {.points = 1'500'000});
  auto requests = RequestsFor(test::Declare(volume, VolumeEncoding::kBricks));
  std::vector<std::string> digests;
  for (const int threads : {1, 2}) {
    test::WaitUntilIdle(*server);  // a job gets what is free when its turn comes
    requests[0].mutable_config()->set_threads(threads);
    const auto replies = Converse(*server, requests);
    const auto found = SkeletonOf(replies);
    ASSERT_TRUE(found.ok()) << found.status();
    digests.push_back(found->sha256);
    EXPECT_EQ(replies.responses.back().summary().threads(), threads);
  }
  EXPECT_EQ(digests[0], digests[1]);
}

}  // namespace
}  // namespace bccskel
