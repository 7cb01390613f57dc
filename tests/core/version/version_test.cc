#include "core/version/version.h"

#include <gmock/gmock.h>

#include <string>

namespace bccskel {
namespace {

TEST(Version, IsThreeNumbersJoinedByDots) {
  EXPECT_THAT(std::string(Version()), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

}  // namespace
}  // namespace bccskel
