#include "server/calls/sender_clock.h"

#include <gtest/gtest.h>

namespace bccskel::server {
namespace {

using std::chrono::seconds;

constexpr std::chrono::milliseconds kLimit(10'000);
constexpr SenderClock::TimePoint At(int second) { return SenderClock::TimePoint(seconds(second)); }

TEST(SenderClock, OnlyTheTimeCountsThatTheServerWaits) {
  SenderClock clock;
  EXPECT_TRUE(clock.Check(At(100), kLimit).ok());
  clock.Await(At(100));
  EXPECT_TRUE(clock.Check(At(110), kLimit).ok());
  EXPECT_EQ(clock.Check(At(111), kLimit).code(), absl::StatusCode::kAborted);
  clock.Take(At(106), 0);
  EXPECT_TRUE(clock.Check(At(1000), kLimit).ok()) << "the server is busy, or all has come";
  clock.Await(At(1000));
  EXPECT_TRUE(clock.Check(At(1004), kLimit).ok());
  EXPECT_FALSE(clock.Check(At(1005), kLimit).ok());
  EXPECT_TRUE(clock.Check(At(9999), std::chrono::milliseconds(0)).ok()) << "no limit";
}

TEST(SenderClock, EachMebibyteGivesNewTimeAndDropsDoNot) {
  SenderClock clock;
  clock.Await(At(0));
  clock.Take(At(9), SenderClock::kBytesInTime - 1);
  clock.Await(At(9));
  EXPECT_FALSE(clock.Check(At(11), kLimit).ok());
  clock.Take(At(10), 1);
  clock.Await(At(10));
  EXPECT_TRUE(clock.Check(At(20), kLimit).ok());
}

}  // namespace
}  // namespace bccskel::server
