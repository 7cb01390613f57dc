#include "core/exec/context.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "core/exec/status_macros.h"

namespace bccskel::exec {
namespace {

TEST(Context, ByDefaultIsOneThreadThatNeverStopsAndTellsNobody) {
  const Context context;
  EXPECT_EQ(context.threads(), 1);
  EXPECT_FALSE(context.ShouldStop());
  EXPECT_TRUE(context.StopStatus().ok());
  context.Report({.shell = 1});
  std::vector<int> workers;
  context.Run(context.threads(), [&](int worker) { workers.push_back(worker); });
  EXPECT_EQ(workers, std::vector<int>{0});
}

TEST(Context, RunsOnItsTeam) {
  WorkerTeam team(3);
  Context context;
  context.team = &team;
  EXPECT_EQ(context.threads(), 3);
  std::vector<int> ran(3);
  context.Run(3, [&](int worker) { ran[static_cast<size_t>(worker)] = 1; });
  EXPECT_EQ(ran, std::vector<int>(3, 1));
}

TEST(Context, SharesWorkAmongThreadsThatAreNotLeftToOthers) {
  WorkerTeam team(3);
  Context context;
  context.team = &team;
  context.min_bricks_per_worker = 1;
  EXPECT_EQ(context.WorkersFor(100), 3);
  int share = 2;
  context.share = [&share] { return share; };
  EXPECT_EQ(context.WorkersFor(100), 2);
  share = 1;
  EXPECT_EQ(context.WorkersFor(100), 1);
  EXPECT_EQ(context.MeetingWorkersFor(100), 1);
  share = 7;
  EXPECT_EQ(context.WorkersFor(100), 3);
}

TEST(Context, StopsWhenAskedTo) {
  std::stop_source source;
  Context context;
  context.stop = source.get_token();
  EXPECT_FALSE(context.ShouldStop());
  source.request_stop();
  EXPECT_TRUE(context.ShouldStop());
  EXPECT_EQ(context.StopStatus().code(), absl::StatusCode::kCancelled);
}

TEST(Context, StopsAtItsDeadline) {
  Context context;
  context.deadline = Context::Clock::now() + std::chrono::hours(1);
  EXPECT_FALSE(context.ShouldStop());
  EXPECT_TRUE(context.StopStatus().ok());
  context.deadline = Context::Clock::now() - std::chrono::nanoseconds(1);
  EXPECT_TRUE(context.ShouldStop());
  EXPECT_EQ(context.StopStatus().code(), absl::StatusCode::kDeadlineExceeded);
}

TEST(Context, CallsAJobThatWasCancelledAfterItsDeadlineCancelled) {
  std::stop_source source;
  source.request_stop();
  Context context;
  context.stop = source.get_token();
  context.deadline = Context::Clock::time_point::min();
  EXPECT_EQ(context.StopStatus().code(), absl::StatusCode::kCancelled);
}

TEST(Context, ReportsToItsListener) {
  std::vector<ShellProgress> reports;
  Context context;
  context.on_shell = [&](const ShellProgress& progress) { reports.push_back(progress); };
  context.Report({.shell = 2, .last_shell = 5, .points = 40, .removed = 30, .remaining = 10});
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].shell, 2);
  EXPECT_EQ(reports[0].last_shell, 5);
  EXPECT_EQ(reports[0].remaining, 10u);
}

TEST(Context, GivesAWorkerAtLeastTheLeastNumberOfBricks) {
  WorkerTeam team(4);
  Context context;
  context.team = &team;
  context.min_bricks_per_worker = 100;
  EXPECT_EQ(context.WorkersFor(0), 1);
  EXPECT_EQ(context.WorkersFor(199), 1);
  EXPECT_EQ(context.WorkersFor(200), 2);
  EXPECT_EQ(context.WorkersFor(399), 3);
  EXPECT_EQ(context.WorkersFor(1000000), 4);
  context.min_bricks_per_worker = 0;
  EXPECT_EQ(context.WorkersFor(0), 1);
  EXPECT_EQ(context.WorkersFor(3), 3);
}

// The clock has to pass, so times are short; what is compared are orders of them.
TEST(Context, LetsNobodyMeetForAWhileAfterAMeetingTookLong) {
  using std::chrono::milliseconds;
  WorkerTeam team(2);
  Context context;
  context.team = &team;
  context.min_bricks_per_worker = 1;
  EXPECT_EQ(context.MeetingWorkersFor(1), 1);
  EXPECT_EQ(context.MeetingWorkersFor(100), 2);
  const auto start = Context::Clock::now();
  team.in_lockstep().Lose(milliseconds(5));
  EXPECT_EQ(context.WorkersFor(100), 2);
  while (context.MeetingWorkersFor(100) == 1) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_GE(Context::Clock::now() - start, milliseconds(60));
}

TEST(Context, GoesOnOfferingWorkWhenMeetingsTookLong) {
  WorkerTeam team(2);
  Context context;
  context.team = &team;
  team.in_lockstep().Lose(std::chrono::hours(1));
  std::atomic<bool> came{false};
  context.Offer([&came](int worker) {
    if (worker == 1) came = true;
    while (!came) std::this_thread::yield();  // hangs unless the other is asked
  });
  EXPECT_TRUE(came);
}

TEST(Context, LetsNobodyMeetForTwiceAsLongWhileMeetingsGoOnTakingLong) {
  using std::chrono::milliseconds;
  const auto pause = [](Confidence& confidence, milliseconds waited) {
    const auto start = Context::Clock::now();
    confidence.Lose(waited);
    while (!confidence.Holds()) std::this_thread::sleep_for(milliseconds(1));
    return Context::Clock::now() - start;
  };
  Confidence confidence;
  EXPECT_GE(pause(confidence, milliseconds(3)), milliseconds(36));
  EXPECT_GE(pause(confidence, milliseconds(0)), milliseconds(72));
  confidence.Gain(milliseconds(20));  // not as long as the pause
  EXPECT_GE(pause(confidence, milliseconds(0)), milliseconds(144));
  confidence.Gain(milliseconds(100));
  confidence.Gain(milliseconds(100));
  confidence.Lose(milliseconds(0));
  EXPECT_TRUE(confidence.Holds());  // what was before is forgotten
}

TEST(Context, NeverLetsAWaitCostMoreThanSeconds) {
  Confidence confidence;
  confidence.Lose(std::chrono::hours(1));
  EXPECT_FALSE(confidence.Holds());
  const auto start = Context::Clock::now();
  while (!confidence.Holds()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_GE(Context::Clock::now() - start, std::chrono::milliseconds(3200));
}

TEST(InstructionSets, CanAllBeChosenAndTheEmptyNameMeansTheBest) {
  const std::vector<std::string> names = SupportedInstructionSets();
  ASSERT_FALSE(names.empty());
  for (const std::string& name : names) {
    ASSERT_TRUE(ChooseInstructionSet(name)) << name;
    EXPECT_EQ(ChosenInstructionSet(), name);
    EXPECT_EQ(SupportedInstructionSets(), names) << "asking must not depend on the choice";
    EXPECT_EQ(ChosenInstructionSet(), name) << "asking must not change the choice";
  }
  EXPECT_TRUE(ChooseInstructionSet(""));
  EXPECT_EQ(ChosenInstructionSet(), names.front());
}

TEST(InstructionSets, AnUnknownNameChangesNothing) {
  const std::string last = SupportedInstructionSets().back();
  ASSERT_TRUE(ChooseInstructionSet(last));
  EXPECT_FALSE(ChooseInstructionSet("MMX"));
  EXPECT_EQ(ChosenInstructionSet(), last);
  EXPECT_TRUE(ChooseInstructionSet(""));
}

absl::StatusOr<std::unique_ptr<int>> Half(int value) {
  if (value % 2 != 0) return absl::InvalidArgumentError("odd");
  return std::make_unique<int>(value / 2);
}

absl::StatusOr<int> Quarter(int value) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::unique_ptr<int> half, Half(value));
  BCCSKEL_ASSIGN_OR_RETURN(const std::unique_ptr<int> quarter, Half(*half));
  BCCSKEL_RETURN_IF_ERROR(Half(2 * *quarter).status());
  return *quarter;
}

TEST(StatusMacros, PassValuesOnAndReturnErrorsAtOnce) {
  EXPECT_EQ(*Quarter(12), 3);
  EXPECT_EQ(Quarter(3).status(), absl::InvalidArgumentError("odd"));
  EXPECT_EQ(Quarter(6).status(), absl::InvalidArgumentError("odd"));
}

}  // namespace
}  // namespace bccskel::exec
