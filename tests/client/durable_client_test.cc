#include "client/durable_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <set>
#include <utility>
#include <vector>

#include "client/skeleton_reading.h"
#include "core/import/shapes/shapes.h"
#include "tests/client/support/fake_server.h"

// What is tried again, and from where it goes on.

namespace bccskel::client::durable_client {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

absl::Status Break() { return absl::UnavailableError("the connection broke"); }

// What a scripted stub was asked.
struct Asked {
  std::vector<std::string> uploads;
  std::vector<DurableStub::Begun> begun;  // of each upload
  std::vector<std::string> request_ids;
  std::vector<uint64_t> watched_after;
  std::vector<uint32_t> read_from;
};

// An attempt at a watch: the events that come, and how it ends.
struct WatchAttempt {
  std::vector<JobEvent> events;
  absl::Status status;
};

struct Script {
  std::string found = {};                   // the volume that the server has
  std::deque<absl::Status> ends = {};       // of attempts at unary calls and uploads, then OK
  std::deque<WatchAttempt> watches = {};    // in turn
  std::deque<uint32_t> pieces_a_read = {};  // that come before a break; then all the rest
  std::vector<v1::SkeletonizeResponse> result = {};
};

class ScriptedStub : public DurableStub {
 public:
  ScriptedStub(Script script, Asked& asked) : script_(std::move(script)), asked_(asked) {}

  absl::StatusOr<std::string> FindVolume(const EncodedVolume&, const Limits&) override {
    return script_.found;
  }
  absl::StatusOr<std::string> Upload(const std::string& upload, Begun begun, const EncodedVolume&,
                                     const Limits&) override {
    asked_.uploads.push_back(upload);
    asked_.begun.push_back(begun);
    const absl::Status status = Next();
    if (!status.ok()) return status;
    return "volumes/1";
  }
  absl::StatusOr<DurableJob> CreateJob(const NewJob& job, const Limits&) override {
    asked_.request_ids.push_back(job.request_id);
    return SomeJob();
  }
  absl::StatusOr<DurableJob> GetJob(const std::string&, const Limits&) override {
    return SomeJob();
  }
  absl::StatusOr<JobPage> ListJobs(int, const std::string&, const Limits&) override {
    return JobPage();
  }
  absl::StatusOr<DurableJob> CancelJob(const std::string&, const Limits&) override {
    return SomeJob();
  }
  absl::Status DeleteJob(const std::string&, const Limits&) override { return Next(); }
  absl::Status WatchJob(const std::string&, uint64_t after_sequence, const EventConsumer& consume,
                        const Limits&) override {
    asked_.watched_after.push_back(after_sequence);
    const WatchAttempt attempt = std::move(script_.watches.front());
    script_.watches.pop_front();
    for (const JobEvent& event : attempt.events) consume(event);
    return attempt.status;
  }
  absl::Status ReadSkeleton(const std::string&, SkeletonReading& reading, const Limits&) override;

 private:
  absl::Status Next() {
    if (script_.ends.empty()) return absl::OkStatus();
    absl::Status status = script_.ends.front();
    script_.ends.pop_front();
    return status;
  }
  absl::StatusOr<DurableJob> SomeJob() {
    const absl::Status status = Next();
    if (!status.ok()) return status;
    return DurableJob();
  }

  Script script_;
  Asked& asked_;
};

absl::Status AddPiece(const v1::SkeletonizeResponse& piece, SkeletonReading& reading) {
  if (piece.has_skeleton_chunk()) return reading.Add(piece.skeleton_chunk());
  if (piece.has_thin_volume_chunk()) return reading.Add(piece.thin_volume_chunk());
  return reading.Add(piece.summary());
}

absl::Status ScriptedStub::ReadSkeleton(const std::string&, SkeletonReading& reading,
                                        const Limits&) {
  asked_.read_from.push_back(reading.pieces());
  const bool breaks = !script_.pieces_a_read.empty();
  size_t end = script_.result.size();
  if (breaks) {
    end = reading.pieces() + script_.pieces_a_read.front();
    script_.pieces_a_read.pop_front();
  }
  for (size_t n = reading.pieces(); n < end; ++n) {
    const absl::Status added = AddPiece(script_.result[n], reading);
    if (!added.ok()) return added;
  }
  return breaks ? Break() : absl::OkStatus();
}

JobEvent Shell(uint64_t sequence) {
  return {.sequence = sequence, .state = {}, .error = {}, .shell = exec::ShellProgress()};
}
JobEvent Enters(uint64_t sequence, JobState state) {
  return {.sequence = sequence, .state = state, .error = {}, .shell = {}};
}

class DurableClientTest : public testing::Test {
 protected:
  DurableClient ClientOf(Script script, const RetryPolicy& policy = {}) {
    return DurableClient(std::make_unique<ScriptedStub>(std::move(script), asked_), policy,
                         [this](milliseconds, const std::stop_token&) { ++pauses_; });
  }

  Asked asked_;
  int pauses_ = 0;
};

TEST_F(DurableClientTest, SendsNoVolumeThatTheServerHas) {
  DurableClient client = ClientOf({.found = "volumes/7"});
  EXPECT_EQ(*client.Upload({}, {}), "volumes/7");
  EXPECT_TRUE(asked_.uploads.empty());
}

TEST_F(DurableClientTest, GoesOnWithAnUploadUnderItsName) {
  DurableClient client = ClientOf({.ends = {Break(), Break()}});
  EXPECT_EQ(*client.Upload({}, {}), "volumes/1");
  EXPECT_EQ(asked_.uploads.size(), 3u);
  EXPECT_EQ(std::set(asked_.uploads.begin(), asked_.uploads.end()).size(), 1u);
  using Begun = DurableStub::Begun;
  EXPECT_THAT(asked_.begun, ElementsAre(Begun::kNo, Begun::kMaybe, Begun::kMaybe))
      << "what cannot be there is not asked for";
  EXPECT_EQ(pauses_, 2);
}

TEST_F(DurableClientTest, GoesOnWithAnUploadWhoseOlderBytesCameLate) {
  DurableClient client =
      ClientOf({.ends = {absl::OutOfRangeError("9 bytes were received so far")}});
  EXPECT_EQ(*client.Upload({}, {}), "volumes/1");
  EXPECT_EQ(asked_.uploads.size(), 2u);
}

TEST_F(DurableClientTest, AsksForAJobAgainWithTheSameRequestId) {
  DurableClient client = ClientOf({.ends = {Break()}});
  EXPECT_TRUE(client.CreateJob({}, {}).ok());
  ASSERT_EQ(asked_.request_ids.size(), 2u);
  EXPECT_EQ(asked_.request_ids[0], asked_.request_ids[1]);
  EXPECT_EQ(asked_.request_ids[0].size(), 32u);
}

TEST_F(DurableClientTest, KeepsTheCallersRequestIdAndMakesEachOwnOneAnew) {
  DurableClient client = ClientOf({});
  NewJob mine;
  mine.request_id = "mine";
  EXPECT_TRUE(client.CreateJob(mine, {}).ok());
  EXPECT_TRUE(client.CreateJob({}, {}).ok());
  EXPECT_TRUE(client.CreateJob({}, {}).ok());
  EXPECT_EQ(asked_.request_ids[0], "mine");
  EXPECT_NE(asked_.request_ids[1], asked_.request_ids[2]);
}

TEST_F(DurableClientTest, TriesNothingAgainThatWouldFailAgain) {
  for (const absl::Status& error :
       {absl::NotFoundError("x"), absl::InvalidArgumentError("x"), absl::DataLossError("x"),
        absl::ResourceExhaustedError("x"), absl::InternalError("x"), absl::AbortedError("x")}) {
    DurableClient client = ClientOf({.ends = {error}});
    EXPECT_EQ(client.DeleteJob("jobs/1", {}), error);
  }
  EXPECT_EQ(pauses_, 0);
}

TEST_F(DurableClientTest, GivesUpAfterAsManyAttemptsAsItsPolicySays) {
  DurableClient client =
      ClientOf({.ends = {Break(), Break(), Break(), Break()}}, {.max_attempts = 3});
  EXPECT_EQ(client.GetJob("jobs/1", {}).status(), Break());
  EXPECT_EQ(pauses_, 2);
}

TEST_F(DurableClientTest, EndsAsCancelledWhenItIsStoppedInAPause) {
  std::stop_source stop;
  Script script = {.ends = {Break()}};
  DurableClient client(std::make_unique<ScriptedStub>(std::move(script), asked_), {},
                       [&](milliseconds, const std::stop_token&) { stop.request_stop(); });
  EXPECT_TRUE(absl::IsCancelled(client.GetJob("jobs/1", {.stop = stop.get_token()}).status()));
}

TEST_F(DurableClientTest, WatchesOnFromTheLastEventThatCame) {
  DurableClient client = ClientOf(
      {.watches = {{{Enters(1, JobState::kQueued), Enters(2, JobState::kRunning)}, Break()},
                   {{}, Break()},
                   {{Shell(5)}, Break()},
                   {{Enters(6, JobState::kSucceeded)}, absl::OkStatus()}}});
  std::vector<uint64_t> told;
  const auto state =
      client.Watch("jobs/1", [&](const JobEvent& event) { told.push_back(event.sequence); }, {});
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(*state, JobState::kSucceeded);
  EXPECT_THAT(told, ElementsAre(1, 2, 5, 6));
  EXPECT_THAT(asked_.watched_after, ElementsAre(0, 2, 2, 5));
}

TEST_F(DurableClientTest, CountsBreaksOfAWatchAnewOnceSomethingCame) {
  Script script;
  for (uint64_t n = 1; n <= 6; ++n) script.watches.push_back({{Shell(n)}, Break()});
  script.watches.push_back({{Enters(7, JobState::kFailed)}, absl::OkStatus()});
  DurableClient client = ClientOf(std::move(script), {.max_attempts = 2});
  EXPECT_EQ(*client.Watch("jobs/1", {}, {}), JobState::kFailed);
}

TEST_F(DurableClientTest, AwaitsAJobWithItsShellsAndItsError) {
  JobEvent failed = Enters(3, JobState::kFailed);
  failed.error = absl::ResourceExhaustedError("too large");
  DurableClient client = ClientOf(
      {.watches = {{{Shell(1), Shell(2), Enters(3, JobState::kSucceeded)}, absl::OkStatus()},
                   {{failed}, absl::OkStatus()},
                   {{Enters(3, JobState::kCancelled)}, absl::OkStatus()}}});
  int shells = 0;
  EXPECT_TRUE(client.Await("jobs/1", [&](const exec::ShellProgress&) { ++shells; }, {}).ok());
  EXPECT_EQ(shells, 2);
  EXPECT_EQ(client.Await("jobs/1", {}, {}), failed.error);
  EXPECT_TRUE(absl::IsCancelled(client.Await("jobs/1", {}, {})));
}

TEST_F(DurableClientTest, TakesAWatchThatEndsWithoutTheJobsEndForADefect) {
  DurableClient client =
      ClientOf({.watches = {{{Enters(1, JobState::kRunning)}, absl::OkStatus()}}});
  EXPECT_TRUE(absl::IsDataLoss(client.Watch("jobs/1", {}, {}).status()));
}

class FetchTest : public DurableClientTest {
 protected:
  FetchTest() {
    for (v1::SkeletonizeResponse& reply : RepliesFor(torus_)) {
      if (!reply.has_accepted() && !reply.has_shell_progress()) pieces_.push_back(std::move(reply));
    }
  }

  const SkeletonizeResult torus_ =
      *Skeletonize(*GenerateShape(Shape::kTorus, {.points = 5000}), {}, {});
  std::vector<v1::SkeletonizeResponse> pieces_;
};

TEST_F(FetchTest, ReadsOnFromTheFirstPieceThatIsMissing) {
  DurableClient client = ClientOf({.pieces_a_read = {1, 0, 1}, .result = pieces_});
  const auto result = client.Fetch("jobs/1", {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->graph, torus_.graph);
  EXPECT_EQ(result->sha256, torus_.sha256);
  EXPECT_THAT(asked_.read_from, ElementsAre(0, 1, 1, 2));
}

TEST_F(FetchTest, TakesAResultWithoutItsSummaryForDamaged) {
  pieces_.pop_back();
  DurableClient client = ClientOf({.result = pieces_});
  EXPECT_TRUE(absl::IsDataLoss(client.Fetch("jobs/1", {}).status()));
}

}  // namespace
}  // namespace bccskel::client::durable_client
