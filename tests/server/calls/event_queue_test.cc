#include "server/calls/event_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace bccskel::server {
namespace {

using testing::ElementsAre;

v1::WatchJobResponse Shell(uint64_t sequence) {
  v1::WatchJobResponse event;
  event.set_sequence(sequence);
  event.mutable_shell_progress();
  return event;
}

v1::WatchJobResponse Change(uint64_t sequence) {
  v1::WatchJobResponse event;
  event.set_sequence(sequence);
  event.mutable_state_change();
  return event;
}

std::vector<uint64_t> Rest(EventQueue& queue) {
  std::vector<uint64_t> sequences;
  while (const auto event = queue.Next()) sequences.push_back(event->sequence());
  return sequences;
}

TEST(EventQueueTest, KeepsEveryChangeOfTheStateAndTheNewestShellBetweenTwo) {
  EventQueue queue;
  for (const auto& event :
       {Change(1), Shell(2), Shell(3), Shell(4), Change(5), Shell(6), Change(7)})
    queue.Add(event);
  EXPECT_THAT(Rest(queue), ElementsAre(1, 4, 5, 6, 7));
}

TEST(EventQueueTest, HoldsAsMuchAfterAMillionShellsAsAfterOne) {
  EventQueue queue;
  queue.Add(Change(1));
  constexpr uint64_t kShells = 1'000'000;
  for (uint64_t n = 0; n < kShells; ++n) queue.Add(Shell(2 + n));
  EXPECT_THAT(Rest(queue), ElementsAre(1, kShells + 1));
}

TEST(EventQueueTest, KnowsTheNewestSequenceWhetherItWasReadOrNot) {
  EventQueue queue;
  queue.StartAfter(7);
  EXPECT_EQ(queue.sequence(), 7u);
  queue.Add(Shell(9));
  EXPECT_EQ(queue.sequence(), 9u);
  EXPECT_THAT(Rest(queue), ElementsAre(9));
  EXPECT_EQ(queue.sequence(), 9u);
}

}  // namespace
}  // namespace bccskel::server
