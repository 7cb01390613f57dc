#include "client/retry_policy.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "proto/wire/error_details.h"

namespace bccskel::client::retry_policy {
namespace {

using std::chrono::milliseconds;

const absl::Status kGone = absl::UnavailableError("nobody listens");

std::vector<milliseconds> PausesUntilGivenUp(const RetryPolicy& policy, uint32_t seed) {
  RetryPauses pauses(policy, seed);
  std::vector<milliseconds> all;
  while (const auto pause = pauses.Next(kGone)) all.push_back(*pause);
  return all;
}

TEST(RetryPausesTest, GivesUpAfterAsManyAttemptsAsThePolicyAllows) {
  EXPECT_EQ(PausesUntilGivenUp({.max_attempts = 5}, 1).size(), 4);
  EXPECT_EQ(PausesUntilGivenUp({.max_attempts = 1}, 1).size(), 0);
}

TEST(RetryPausesTest, GrowsByTheFactorUpToTheLongestPauseWithJitterInTheUpperHalf) {
  const RetryPolicy policy = {.max_attempts = 12,
                              .first_pause = milliseconds(100),
                              .longest_pause = milliseconds(1000),
                              .growth = 2};
  for (uint32_t seed = 1; seed <= 50; ++seed) {
    double full = 100;
    for (const milliseconds pause : PausesUntilGivenUp(policy, seed)) {
      EXPECT_GE(pause.count(), static_cast<int64_t>(full / 2));
      EXPECT_LE(pause.count(), static_cast<int64_t>(full));
      full = std::min(2 * full, 1000.0);
    }
  }
}

TEST(RetryPausesTest, SpreadsClientsThatFailedTogether) {
  EXPECT_NE(PausesUntilGivenUp({}, 1), PausesUntilGivenUp({}, 2));
}

TEST(RetryPausesTest, NoOtherErrorIsTriedAgain) {
  for (int code = 1; code <= 16; ++code) {
    const absl::Status error(static_cast<absl::StatusCode>(code), "error");
    if (absl::IsUnavailable(error)) continue;
    EXPECT_EQ(RetryPauses({}, 1).Next(error), std::nullopt) << error;
  }
}

TEST(RetryPausesTest, AServerThatNamesADelayIsAskedAgainWithoutEndAndNeverEarlier) {
  RetryPauses pauses({.max_attempts = 2}, 1);
  const absl::Status busy = wire::WithRetryDelay(kGone, absl::Milliseconds(300));
  for (int n = 0; n < 100; ++n) {
    const auto pause = pauses.Next(busy);
    ASSERT_TRUE(pause.has_value());
    EXPECT_GE(*pause, milliseconds(300));
  }
}

TEST(RetryPausesTest, AServerCannotMakeAClientWaitForDays) {
  const absl::Status busy = wire::WithRetryDelay(kGone, absl::Hours(1000));
  EXPECT_LE(*RetryPauses({}, 1).Next(busy), std::chrono::hours(2));
  const absl::Status odd = wire::WithRetryDelay(kGone, absl::Hours(-1000));
  EXPECT_GE(*RetryPauses({}, 1).Next(odd), milliseconds(0));
}

TEST(PauseForTest, EndsWhenAStopIsRequested) {
  std::stop_source source;
  std::jthread stopper([&source] { source.request_stop(); });
  PauseFor(std::chrono::hours(10), source.get_token());  // the test's time limit judges
}

}  // namespace
}  // namespace bccskel::client::retry_policy
