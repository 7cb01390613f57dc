#include "client/connection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <utility>
#include <vector>

namespace bccskel::client {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::Le;

// What a scripted stub was asked.
struct Attempts {
  std::vector<Stub::Clock::time_point> deadlines;
  int labels_first = 0;  // that are delivered before the first attempt's end
};

// Fails with each status of a script in turn, then succeeds.
class ScriptedStub : public Stub {
 public:
  ScriptedStub(std::deque<absl::Status> script, Attempts& attempts)
      : script_(std::move(script)), attempts_(attempts) {}

  absl::StatusOr<SkeletonizeResult> Skeletonize(const EncodedVolume&, const CallOptions&,
                                                Clock::time_point deadline) override {
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

class ConnectionTest : public testing::Test {
 protected:
  std::shared_ptr<Connection> ConnectionTo(std::deque<absl::Status> script,
                                           const RetryPolicy& policy = {}) {
    return MakeRetryingConnection(
        std::make_unique<ScriptedStub>(std::move(script), attempts_), policy,
        [this](milliseconds pause, const std::stop_token&) { pauses_.push_back(pause); });
  }

  Attempts attempts_;
  std::vector<milliseconds> pauses_;
};

const absl::Status kGone = absl::UnavailableError("nobody listens");

TEST_F(ConnectionTest, ServesTheFirstAnswerWithoutPause) {
  const auto result = ConnectionTo({})->Skeletonize({}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->object_points, 42);
  EXPECT_EQ(attempts_.deadlines.size(), 1);
  EXPECT_TRUE(pauses_.empty());
}

TEST_F(ConnectionTest, TriesAgainWhileTheServerIsUnavailable) {
  const auto result = ConnectionTo({kGone, kGone, kGone})->Skeletonize({}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(attempts_.deadlines.size(), 4);
  EXPECT_THAT(pauses_, ElementsAre(AllOf(Ge(milliseconds(50)), Le(milliseconds(100))),
                                   AllOf(Ge(milliseconds(100)), Le(milliseconds(200))),
                                   AllOf(Ge(milliseconds(200)), Le(milliseconds(400)))));
}

TEST_F(ConnectionTest, ReportsTheServersErrorAfterTheLastAttempt) {
  const auto result = ConnectionTo({kGone, kGone, kGone}, {.max_attempts = 3})->Skeletonize({}, {});
  EXPECT_EQ(result.status(), kGone);
  EXPECT_EQ(attempts_.deadlines.size(), 3);
}

TEST_F(ConnectionTest, NoOtherErrorIsTriedAgain) {
  for (int code = 1; code <= 16; ++code) {
    const absl::Status error(static_cast<absl::StatusCode>(code), "final");
    if (absl::IsUnavailable(error)) continue;
    attempts_.deadlines.clear();
    EXPECT_EQ(ConnectionTo({error})->Skeletonize({}, {}).status(), error);
    EXPECT_EQ(attempts_.deadlines.size(), 1) << error;
  }
}

TEST_F(ConnectionTest, AllAttemptsShareOneDeadline) {
  const auto before = Stub::Clock::now();
  ASSERT_TRUE(
      ConnectionTo({kGone, kGone})->Skeletonize({}, {.timeout = std::chrono::hours(2)}).ok());
  ASSERT_EQ(attempts_.deadlines.size(), 3);
  EXPECT_THAT(attempts_.deadlines, Each(attempts_.deadlines.front()));
  EXPECT_GE(attempts_.deadlines.front(), before + std::chrono::hours(2));
  EXPECT_LE(attempts_.deadlines.front(), Stub::Clock::now() + std::chrono::hours(2));
}

TEST_F(ConnectionTest, DoesNotBeginAPauseThatWouldPassTheDeadline) {
  const RetryPolicy slow = {.first_pause = std::chrono::hours(4),
                            .longest_pause = std::chrono::hours(4)};
  const auto result =
      ConnectionTo({kGone}, slow)->Skeletonize({}, {.timeout = std::chrono::hours(1)});
  EXPECT_EQ(result.status(), kGone);
  EXPECT_TRUE(pauses_.empty());
}

TEST_F(ConnectionTest, AStopDuringAPauseIsTheEnd) {
  std::stop_source source;
  const auto connection =
      MakeRetryingConnection(std::make_unique<ScriptedStub>(std::deque{kGone}, attempts_), {},
                             [&](milliseconds, const std::stop_token& stop) {
                               source.request_stop();
                               EXPECT_TRUE(stop.stop_requested());
                             });
  const auto result = connection->Skeletonize({}, {.stop = source.get_token()});
  EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
  EXPECT_EQ(attempts_.deadlines.size(), 1);
}

absl::Status TakeAll(LabelSkeleton&&) { return absl::OkStatus(); }

TEST_F(ConnectionTest, LabelsAreTriedAgainBeforeTheFirstOne) {
  const auto report = ConnectionTo({kGone, kGone})->SkeletonizeLabels({}, {}, TakeAll);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->labels, 2u);
  EXPECT_EQ(attempts_.deadlines.size(), 3);
}

TEST_F(ConnectionTest, NothingIsTriedAgainAfterTheFirstLabel) {
  attempts_.labels_first = 1;
  const auto report = ConnectionTo({kGone})->SkeletonizeLabels({}, {}, TakeAll);
  EXPECT_EQ(report.status(), kGone);
  EXPECT_EQ(attempts_.deadlines.size(), 1);
}

TEST_F(ConnectionTest, DescribesTheServerWithTheSamePatience) {
  const auto description = ConnectionTo({kGone})->Describe(std::chrono::hours(1));
  ASSERT_TRUE(description.ok()) << description.status();
  EXPECT_EQ(description->server_version, "1.2.3");
  EXPECT_EQ(description->algorithm_version, "paper-1");
  EXPECT_EQ(attempts_.deadlines.size(), 2);
}

}  // namespace
}  // namespace bccskel::client
