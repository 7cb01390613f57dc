#include "core/exec/meeting_team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>

namespace bccskel::exec {
namespace {

constexpr size_t kItems = 12;
constexpr int kSteps = 5;

// How many of kSteps steps each worker does where all share kItems items, and that all are done.
std::array<int, 3> StepsOfWorkers(double patience) {
  WorkerTeam workers(3);
  Context context;
  context.team = &workers;
  context.patience = patience;
  MeetingTeam team(3, context);
  std::array<int, 3> steps = {};
  std::array<std::atomic<size_t>, kSteps> done = {};
  team.Run([&](int worker) {
    for (size_t step = 0; step < kSteps; ++step) {
      ++steps[static_cast<size_t>(worker)];
      const Share mine = team.ShareOf(kItems, worker);
      done[step] += mine.end - mine.begin;
      team.Meet(worker);
      EXPECT_EQ(done[step], kItems);
      if (!team.GoOn(worker)) return;
    }
  });
  return steps;
}

TEST(MeetingTeam, SharesEveryStep) {
  EXPECT_EQ(StepsOfWorkers(1e9), (std::array{kSteps, kSteps, kSteps}));
}

TEST(MeetingTeam, LeavesTheRestToWorker0WhenItLosesPatience) {
  EXPECT_EQ(StepsOfWorkers(-1e9), (std::array{kSteps, 1, 1}));
}

TEST(MeetingTeam, StopsTogether) {
  WorkerTeam workers(3);
  std::stop_source source;
  Context context;
  context.team = &workers;
  context.stop = source.get_token();
  MeetingTeam team(3, context);
  std::atomic<int> ended = 0;
  team.Run([&](int worker) {
    while (team.GoOn(worker)) {
      if (worker == 2) source.request_stop();
      team.Meet(worker);
    }
    ++ended;
  });
  EXPECT_EQ(ended, 3);
}

}  // namespace
}  // namespace bccskel::exec
