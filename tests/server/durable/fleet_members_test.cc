#include "server/durable/fleet_members.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace bccskel::server {
namespace {

using std::chrono::milliseconds, std::chrono::seconds;
using testing::ElementsAre, testing::IsEmpty;

class FleetMembersTest : public testing::Test {
 protected:
  // A second later, or after another time. The names of those who are gone.
  std::vector<std::string> Look(const std::vector<Member>& members,
                                milliseconds later = seconds(1)) {
    now_ += later;
    std::vector<std::string> gone;
    for (const Member& member : members_.Look(members, "self", now_)) gone.push_back(member.server);
    return gone;
  }

  FleetMembers members_{seconds(6)};
  FleetMembers::Clock::time_point now_{std::chrono::hours(1)};
};

TEST_F(FleetMembersTest, OneThatIsSilentForALeaseIsGone) {
  for (int second = 0; second < 6; ++second) {
    EXPECT_THAT(Look({{"self", 1}, {"silent", 5}, {"alive", second}}), IsEmpty()) << second;
  }
  EXPECT_THAT(Look({{"self", 1}, {"silent", 5}, {"alive", 6}}), ElementsAre("silent"));
  EXPECT_TRUE(members_.Has("alive"));
  EXPECT_FALSE(members_.Has("self"));
}

TEST_F(FleetMembersTest, ASignOfLifeBeginsTheLeaseAnew) {
  for (int second = 0; second < 6; ++second) Look({{"other", 5}});
  for (int second = 0; second < 6; ++second) EXPECT_THAT(Look({{"other", 6}}), IsEmpty()) << second;
  EXPECT_THAT(Look({{"other", 6}}), ElementsAre("other"));
}

TEST_F(FleetMembersTest, WhoWasAwayKnowsNothingOfTheOthers) {
  for (int second = 0; second < 5; ++second) Look({{"other", 5}});
  EXPECT_THAT(Look({{"other", 5}}, seconds(30)), IsEmpty()) << "it could not have seen their signs";
  for (int second = 0; second < 5; ++second) EXPECT_THAT(Look({{"other", 5}}), IsEmpty()) << second;
  EXPECT_THAT(Look({{"other", 5}}), ElementsAre("other"));
}

TEST_F(FleetMembersTest, OneThatHasLeftIsForgotten) {
  for (int second = 0; second < 5; ++second) Look({{"other", 5}});
  Look({});
  EXPECT_FALSE(members_.Has("other"));
  EXPECT_THAT(Look({{"other", 5}}), IsEmpty()) << "it has joined anew";
}

}  // namespace
}  // namespace bccskel::server
