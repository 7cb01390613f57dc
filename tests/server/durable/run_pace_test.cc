#include "server/durable/run_pace.h"

#include <gtest/gtest.h>

namespace bccskel::server {
namespace {

using std::chrono::milliseconds;

class RunPaceTest : public testing::Test {
 protected:
  // One run after the other.
  void Compute(milliseconds each, int runs) {
    for (int n = 0; n < runs; ++n) {
      const auto fed = now_;
      now_ += each;
      pace_.Computed(fed, now_);
    }
  }

  RunPace pace_{std::chrono::milliseconds(50)};
  RunPace::Clock::time_point now_{std::chrono::hours(1)};
};

TEST_F(RunPaceTest, BeginsNothingAheadBeforeItKnows) { EXPECT_EQ(pace_.Ahead(), 0); }

TEST_F(RunPaceTest, BeginsWhatHasItsTurnWithin50Milliseconds) {
  Compute(milliseconds(20), 1);
  EXPECT_EQ(pace_.Ahead(), 2);
  Compute(milliseconds(1), 100);
  EXPECT_EQ(pace_.Ahead(), RunPace::kMostAhead);
}

TEST_F(RunPaceTest, BeginsNothingAheadOfALongRun) {
  Compute(milliseconds(5), 100);
  Compute(milliseconds(2000), 1);
  EXPECT_EQ(pace_.Ahead(), 0);
}

TEST_F(RunPaceTest, CountsTheTimeBetweenRunsThatWereGivenTheirVolumesTogether) {
  const auto fed = now_;
  for (int n = 1; n <= 8; ++n) pace_.Computed(fed, now_ + n * milliseconds(10));
  EXPECT_EQ(pace_.Ahead(), 5);
}

}  // namespace
}  // namespace bccskel::server
