#include "client/skeletonize_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/io/volume_decoder.h"

namespace bccskel::client {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::Le;

TEST(EncodedVolumeTest, SparseObjectsTravelAsBricksAndFullBoxesAsOpenExr) {
  EXPECT_EQ(BestEncodingOf(*GenerateShape(Shape::kTubes, {.points = 200'000})),
            VolumeEncoding::kBricks);
  EXPECT_EQ(BestEncodingOf(*GenerateShape(Shape::kBox, {.points = 200'000})),
            VolumeEncoding::kOpenExr);
}

// 3 x 2 x 2 voxels of 16 bits.
constexpr std::array<uint16_t, 12> kLabels = {7, 7, 0, 300, 7, 7, 7, 0, 0, 0, 300, 300};

LabelVolume SomeLabels() {
  return {.grid = {.nx = 3, .ny = 2, .nz = 2, .placement = {}},
          .label_bytes = 2,
          .voxels = std::as_bytes(std::span(kLabels))};
}

TEST(EncodedLabelsTest, PromisesWhatIsThere) {
  const auto all = EncodeForSending(SomeLabels(), {}, {});
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_EQ(all->voxels, 8u);
  EXPECT_EQ(all->largest_voxels, 5u);
  EXPECT_EQ(all->runs, 5u);
  EXPECT_EQ(all->labels, 2u);
  const auto one = EncodeForSending(SomeLabels(), {300}, {});
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_EQ(one->voxels, 3u);
  EXPECT_EQ(one->runs, 2u);
  EXPECT_EQ(one->labels, 1u);
}

TEST(EncodedLabelsTest, RefusesWhatIsNoVolume) {
  LabelVolume odd = SomeLabels(), cut = SomeLabels(), flat = SomeLabels();
  odd.label_bytes = 3;
  cut.voxels = cut.voxels.first(23);
  flat.grid.nz = 0;
  for (const LabelVolume& volume : {odd, cut, flat}) {
    EXPECT_TRUE(absl::IsInvalidArgument(EncodeForSending(volume, {}, {}).status()));
  }
}

// What a scripted stub was asked.
struct Attempts {
  EncodedVolume sent;
  int threads = 0;
  std::vector<Stub::Clock::time_point> deadlines;
  int labels_first = 0;  // that are delivered before the first attempt's end
};

// Fails with each status of a script in turn, then succeeds.
class ScriptedStub : public Stub {
 public:
  ScriptedStub(std::deque<absl::Status> script, Attempts& attempts)
      : script_(std::move(script)), attempts_(attempts) {}

  absl::StatusOr<SkeletonizeResult> Skeletonize(const EncodedVolume& volume,
                                                const CallOptions& options,
                                                Clock::time_point deadline) override {
    attempts_.sent = volume;
    attempts_.threads = options.threads;
    const absl::Status status = Next(deadline);
    if (!status.ok()) return status;
    SkeletonizeResult result;
    result.object_points = 42;
    return result;
  }

  absl::StatusOr<LabelsReport> SkeletonizeLabels(const EncodedLabels&, const LabelsCallOptions&,
                                                 const LabelConsumer& consume,
                                                 Clock::time_point deadline) override {
    for (; attempts_.labels_first > 0; --attempts_.labels_first) {
      const absl::Status consumed = consume({});
      if (!consumed.ok()) return consumed;
    }
    const absl::Status status = Next(deadline);
    if (!status.ok()) return status;
    return LabelsReport{.labels = 2};
  }

  absl::StatusOr<ServerDescription> Describe(Clock::time_point deadline) override {
    const absl::Status status = Next(deadline);
    if (!status.ok()) return status;
    return ServerDescription{"1.2.3", "paper-1"};
  }

 private:
  absl::Status Next(Clock::time_point deadline) {
    attempts_.deadlines.push_back(deadline);
    if (script_.empty()) return absl::OkStatus();
    absl::Status status = script_.front();
    script_.pop_front();
    return status;
  }

  std::deque<absl::Status> script_;
  Attempts& attempts_;
};

class SkeletonizeClientTest : public testing::Test {
 protected:
  SkeletonizeClient ClientOf(std::deque<absl::Status> script, const RetryPolicy& policy = {}) {
    return SkeletonizeClient(
        std::make_unique<ScriptedStub>(std::move(script), attempts_), policy,
        [this](milliseconds pause, const std::stop_token&) { pauses_.push_back(pause); });
  }

  const Volume object_ = *GenerateShape(Shape::kBall, {.points = 5000});
  Attempts attempts_;
  std::vector<milliseconds> pauses_;
};

const absl::Status kGone = absl::UnavailableError("nobody listens");

TEST_F(SkeletonizeClientTest, SendsAVolumeThatDecodesToTheSamePoints) {
  for (const Shape shape : {Shape::kTubes, Shape::kBox}) {
    const Volume object = *GenerateShape(shape, {.points = 20000});
    ASSERT_TRUE(ClientOf({}).Skeletonize(object, {.threads = 3}).ok());
    const EncodedVolume& sent = attempts_.sent;
    EXPECT_EQ(sent.extent, object.extent());
    EXPECT_EQ(sent.bricks, object.brick_count());
    EXPECT_EQ(attempts_.threads, 3);
    const auto decoded = DecodeVolume(sent.encoding, sent.bytes);
    EXPECT_TRUE(decoded.ok() && *decoded == object) << ShapeName(shape);
  }
}

TEST_F(SkeletonizeClientTest, ServesTheFirstAnswerWithoutPause) {
  const auto result = ClientOf({}).Skeletonize(object_, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->object_points, 42);
  EXPECT_EQ(attempts_.deadlines.size(), 1);
  EXPECT_TRUE(pauses_.empty());
}

TEST_F(SkeletonizeClientTest, TriesAgainWhileTheServerIsUnavailable) {
  const auto result = ClientOf({kGone, kGone, kGone}).Skeletonize(object_, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(attempts_.deadlines.size(), 4);
  EXPECT_THAT(pauses_, ElementsAre(AllOf(Ge(milliseconds(50)), Le(milliseconds(100))),
                                   AllOf(Ge(milliseconds(100)), Le(milliseconds(200))),
                                   AllOf(Ge(milliseconds(200)), Le(milliseconds(400)))));
}

TEST_F(SkeletonizeClientTest, ReportsTheServersErrorAfterTheLastAttempt) {
  const auto result = ClientOf({kGone, kGone, kGone}, {.max_attempts = 3}).Skeletonize(object_, {});
  EXPECT_EQ(result.status(), kGone);
  EXPECT_EQ(attempts_.deadlines.size(), 3);
}

TEST_F(SkeletonizeClientTest, NoOtherErrorIsTriedAgain) {
  for (int code = 1; code <= 16; ++code) {
    const absl::Status error(static_cast<absl::StatusCode>(code), "final");
    if (absl::IsUnavailable(error)) continue;
    attempts_.deadlines.clear();
    EXPECT_EQ(ClientOf({error}).Skeletonize(object_, {}).status(), error);
    EXPECT_EQ(attempts_.deadlines.size(), 1) << error;
  }
}

TEST_F(SkeletonizeClientTest, AllAttemptsShareOneDeadline) {
  const auto before = Stub::Clock::now();
  ASSERT_TRUE(
      ClientOf({kGone, kGone}).Skeletonize(object_, {.timeout = std::chrono::hours(2)}).ok());
  ASSERT_EQ(attempts_.deadlines.size(), 3);
  EXPECT_THAT(attempts_.deadlines, Each(attempts_.deadlines.front()));
  EXPECT_GE(attempts_.deadlines.front(), before + std::chrono::hours(2));
  EXPECT_LE(attempts_.deadlines.front(), Stub::Clock::now() + std::chrono::hours(2));
}

TEST_F(SkeletonizeClientTest, DoesNotBeginAPauseThatWouldPassTheDeadline) {
  const RetryPolicy slow = {.first_pause = std::chrono::hours(4),
                            .longest_pause = std::chrono::hours(4)};
  const auto result =
      ClientOf({kGone}, slow).Skeletonize(object_, {.timeout = std::chrono::hours(1)});
  EXPECT_EQ(result.status(), kGone);
  EXPECT_TRUE(pauses_.empty());
}

TEST_F(SkeletonizeClientTest, AStopDuringAPauseIsTheEnd) {
  std::stop_source source;
  SkeletonizeClient client(std::make_unique<ScriptedStub>(std::deque{kGone}, attempts_), {},
                           [&](milliseconds, const std::stop_token& stop) {
                             source.request_stop();
                             EXPECT_TRUE(stop.stop_requested());
                           });
  const auto result = client.Skeletonize(object_, {.stop = source.get_token()});
  EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
  EXPECT_EQ(attempts_.deadlines.size(), 1);
}

absl::Status TakeAll(LabelSkeleton&&) { return absl::OkStatus(); }

TEST_F(SkeletonizeClientTest, LabelsAreTriedAgainBeforeTheFirstOne) {
  const auto report = ClientOf({kGone, kGone}).SkeletonizeLabels(SomeLabels(), {}, TakeAll);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->labels, 2u);
  EXPECT_EQ(attempts_.deadlines.size(), 3);
}

TEST_F(SkeletonizeClientTest, NothingIsTriedAgainAfterTheFirstLabel) {
  attempts_.labels_first = 1;
  const auto report = ClientOf({kGone}).SkeletonizeLabels(SomeLabels(), {}, TakeAll);
  EXPECT_EQ(report.status(), kGone);
  EXPECT_EQ(attempts_.deadlines.size(), 1);
}

TEST_F(SkeletonizeClientTest, DescribesTheServerWithTheSamePatience) {
  const auto description = ClientOf({kGone}).Describe(std::chrono::hours(1));
  ASSERT_TRUE(description.ok()) << description.status();
  EXPECT_EQ(description->server_version, "1.2.3");
  EXPECT_EQ(description->algorithm_version, "paper-1");
  EXPECT_EQ(attempts_.deadlines.size(), 2);
}

}  // namespace
}  // namespace bccskel::client
