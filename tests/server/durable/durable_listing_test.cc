#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "tests/server/durable/durable_fixture.h"

namespace bccskel::server {
namespace {

using testing::IsEmpty;

class DurableListingTest : public DurableTest {
 protected:
  void SetUp() override { Open(); }
};

TEST_F(DurableListingTest, ListsJobsPageByPageNewestFirst) {
  const std::string volume = Upload("clinic", "volume");
  std::vector<std::string> names;
  for (int n = 0; n < 5; ++n) names.push_back(CreateName("clinic", JobOf(volume)));
  for (const std::string& name : names) WaitForEnd("clinic", name);
  CreateName("other", JobOf(Upload("other", "volume")));
  JobQuery query;
  query.page_size = 2;
  std::vector<std::string> listed;
  do {
    const auto page = List("clinic", query);
    ASSERT_TRUE(page.ok()) << page.status();
    EXPECT_LE(page->jobs.size(), 2u);
    for (const JobInfo& job : page->jobs) listed.push_back(job.name);
    query.page_token = page->next_token;
  } while (!query.page_token.empty());
  EXPECT_EQ(listed, std::vector<std::string>(names.rbegin(), names.rend()));
  query.states = {JobState::kFailed};
  EXPECT_THAT(List("clinic", query)->jobs, IsEmpty());
  for (const char* token : {"1-63", "!", "MSBqb2JzLzEgNjM", "OTk5OTk5OTk5OTk5OTk5OTk5OTkgeCA2Mw"}) {
    query.page_token = token;
    EXPECT_EQ(List("clinic", query).status().code(), absl::StatusCode::kInvalidArgument) << token;
  }
}

// The jobs of a tenant, one to a page; each is deleted when its page has come.
TEST_F(DurableListingTest, ListsOnWhenJobsOfEarlierPagesAreDeleted) {
  const std::string volume = Upload("clinic", "volume");
  std::vector<std::string> names;
  for (int n = 0; n < 4; ++n) names.push_back(CreateName("clinic", JobOf(volume)));
  JobQuery query;
  query.page_size = 1;
  std::vector<std::string> listed;
  do {
    const auto page = List("clinic", query);
    ASSERT_EQ(page->jobs.size(), 1u);
    listed.push_back(page->jobs[0].name);
    EXPECT_TRUE(Delete("clinic", listed.back()).ok());
    query.page_token = page->next_token;
  } while (!query.page_token.empty());
  EXPECT_EQ(listed, std::vector<std::string>(names.rbegin(), names.rend()));
}

// Whoever has jobs can tell from their names and times alone what the token says.
TEST_F(DurableListingTest, TellsNothingOfOtherTenantsInPageTokens) {
  const auto token_beside = [&](const std::string& tenant, int others) {
    const std::string volume = Upload("other", "volume of " + tenant);
    for (int n = 0; n < others; ++n) CreateName("other", JobOf(volume));
    const std::string own = Upload(tenant, "volume");
    CreateName(tenant, JobOf(own));
    const std::string name = CreateName(tenant, JobOf(own));
    JobQuery query;
    query.page_size = 1;
    const auto page = List(tenant, query);
    EXPECT_EQ(page->jobs[0].name, name);
    std::string text;
    EXPECT_TRUE(absl::WebSafeBase64Unescape(page->next_token, &text));
    const int64_t created = page->jobs[0].created.time_since_epoch().count();
    EXPECT_EQ(text, absl::StrCat(created, " ", name, " 63"));
  };
  token_beside("clinic", 0);
  token_beside("practice", 5);
}

}  // namespace
}  // namespace bccskel::server
