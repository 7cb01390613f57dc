#include "server/identity/token_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "server/identity/callers.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

using testing::HasSubstr;

const std::string kToken = "bccskel_secret", kOther = "bccskel_other";

TokenTable Parsed(const std::string& text) {
  const absl::StatusOr<TokenTable> table = TokenTable::Parse(text);
  EXPECT_TRUE(table.ok()) << table.status();
  return table.value_or(TokenTable());
}

TEST(TokenTable, FindsTheTenantOfATokenAndNothingForAnotherText) {
  const TokenTable table = Parsed("# ours\n\n" + TokenLine("acme", kToken) + " admin # theirs\n" +
                                  TokenLine("lab", kOther) + "\r\n");
  ASSERT_TRUE(table.Find(kToken).has_value());
  EXPECT_EQ(table.Find(kToken)->tenant, "acme");
  EXPECT_EQ(table.Find(kToken)->role, Role::kAdmin);
  EXPECT_EQ(table.Find(kOther)->role, Role::kTenant);
  for (const char* text : {"", "bccskel_secre", "bccskel_secret ", "acme"}) {
    EXPECT_FALSE(table.Find(text).has_value()) << text;
  }
  EXPECT_FALSE(table.Find(Sha256Of(kToken).Hex()).has_value()) << "the digest is no token";
}

TEST(TokenTable, GrantsWhatAnyLineOfTheTenantSays) {
  const TokenTable table =
      Parsed(TokenLine("acme", kToken) + " weight=3 max-jobs=40\n" + TokenLine("acme", kOther) +
             " weight=3 max-running=4 max-memory-bytes=8GB\n");
  const TenantLimits& limits = table.tenants().at("acme");
  EXPECT_EQ(limits.weight, 3);
  EXPECT_EQ(limits.max_jobs, 40);
  EXPECT_EQ(limits.max_running, 4);
  EXPECT_EQ(limits.max_bytes, uint64_t{8} << 30);
  EXPECT_EQ(Parsed(TokenLine("lab", kToken)).tenants().at("lab").weight, 1);
}

TEST(TokenTable, NamesTheLineAndTheFaultButNoDigest) {
  const std::string good = TokenLine("acme", kToken), hex = good.substr(5);
  for (const auto& [text, fault] :
       {std::pair<std::string, std::string>{"Acme " + hex,
                                            "line 1: the first word must be a tenant's name"},
        {"\nacme", "line 2: the SHA-256 of the token is missing"},
        {"acme " + hex.substr(1), "must be the SHA-256 of a token"},
        {"acme G" + hex.substr(1), "must be the SHA-256 of a token"},
        {good + " weight=0", "line 1: weight=0: 0: must be a number from 1 to 1000"},
        {good + " max-jobs", "max-jobs: : must be a number"},
        {good + " colour=red", "line 1: colour=red: must be admin, weight=N"},
        {good + "\n" + "lab " + hex, "line 2: this token is also in another line"},
        {good + " weight=2\n" + TokenLine("acme", kOther) + " weight=3",
         "line 2: weight=3: 3, another line of the same tenant says 2"}}) {
    const absl::Status status = TokenTable::Parse(text).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << text;
    EXPECT_THAT(std::string(status.message()), HasSubstr(fault));
    EXPECT_THAT(std::string(status.message()), testing::Not(HasSubstr(hex)));
  }
}

TEST(TokenTable, NamesEveryFault) {
  const std::string good = TokenLine("acme", kToken);
  const absl::Status status =
      TokenTable::Parse("Acme x\n" + good + " weight=0 admin color=red\nlab\n").status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  for (const char* fault : {"line 1: the first word", "; line 2: weight=0: 0: must be a number",
                            "; line 2: color=red: must be", "; line 3: the SHA-256"}) {
    EXPECT_THAT(std::string(status.message()), HasSubstr(fault));
  }
  std::string text;
  for (int n = 0; n < 1000; ++n) text += "Acme\n";
  EXPECT_THAT(std::string(TokenTable::Parse(text).status().message()),
              testing::AllOf(HasSubstr("line 1: "), HasSubstr("; and 980 more errors"),
                             testing::Not(HasSubstr("line 21:"))));
}

TEST(NewToken, IsLongAndNeverTheSame) {
  const auto one = NewToken(), other = NewToken();
  ASSERT_TRUE(one.ok() && other.ok());
  EXPECT_EQ(one->size(), std::string("bccskel_").size() + 64);
  EXPECT_NE(*one, *other);
}

TEST(Callers, TakeTheSchemeInAnyCaseAndRefuseOtherSchemes) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "tokens") << TokenLine("acme", kToken) << '\n';
  const auto callers = Callers::Create(folder / "tokens");
  ASSERT_TRUE(callers.ok()) << callers.status();
  for (const char* scheme : {"Bearer ", "bearer ", "BEARER "}) {
    const auto caller = (*callers)->Identify(scheme + kToken);
    ASSERT_TRUE(caller.ok()) << caller.status();
    EXPECT_EQ(caller->tenant, "acme");
  }
  for (const std::string& header :
       {kToken, "Basic " + kToken, std::string("Bearer"), std::string("Bearer "), std::string()}) {
    const absl::Status status = (*callers)->Identify(header).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kUnauthenticated);
    EXPECT_THAT(std::string(status.message()), testing::Not(HasSubstr(kToken)));
  }
  EXPECT_TRUE(absl::IsUnauthenticated((*callers)->Identify(std::nullopt).status()));
}

TEST(Callers, ReadTheFileAgainOnlyWhenItHasChanged) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "tokens") << TokenLine("acme", kToken) << '\n';
  const auto callers = Callers::Create(folder / "tokens");
  ASSERT_TRUE(callers.ok()) << callers.status();
  EXPECT_EQ(*(*callers)->ReloadIfChanged(), Reload::kNotNeeded);
  std::ofstream(folder / "new") << "nonsense\n";
  std::filesystem::rename(folder / "new", folder / "tokens");
  EXPECT_FALSE((*callers)->ReloadIfChanged().ok());
  EXPECT_EQ(*(*callers)->ReloadIfChanged(), Reload::kNotNeeded) << "told once";
  EXPECT_TRUE((*callers)->Identify("Bearer " + kToken).ok()) << "what was good before still is";
}

TEST(Callers, WithoutAFileEverybodyIsTheDefaultTenantAndAnAdmin) {
  const auto callers = Callers::Create("");
  ASSERT_TRUE(callers.ok());
  const auto caller = (*callers)->Identify(std::nullopt);
  ASSERT_TRUE(caller.ok());
  EXPECT_EQ(caller->tenant, kDefaultTenant);
  EXPECT_EQ(caller->role, Role::kAdmin);
}

}  // namespace
}  // namespace bccskel::server
