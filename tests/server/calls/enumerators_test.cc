#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "server/calls/durable_messages.h"
#include "server/calls/requests.h"
#include "tests/proto/message_enumerators.h"
#include "tests/support/enum_values.h"

namespace bccskel::server {
namespace {

using test::ForEachEnumerator, test::ValuesOf;

void ExpectKnown(const absl::Status& status, const std::string& enumerator) {
  EXPECT_EQ(status.message().find("unknown"), status.message().npos)
      << enumerator << ": " << status;
}

TEST(RequestEnumerators, OfADeclarationAndItsConfigAreAllKnown) {
  v1::SkeletonizeConfig config;
  v1::VolumeDeclaration& volume = *config.mutable_volume();
  volume.set_encoding(v1::VOLUME_ENCODING_CUBIC_MASK);
  volume.set_size_bytes(1);
  volume.mutable_extent()->set_nx(2);
  volume.mutable_extent()->set_ny(2);
  volume.mutable_extent()->set_nz(2);
  ASSERT_TRUE(JobRequestOf(config, {}).ok()) << JobRequestOf(config, {}).status();
  const auto expect_known = [&](const auto& /*field*/, const auto& enumerator) {
    ExpectKnown(JobRequestOf(config, {}).status(), enumerator.full_name());
  };
  ForEachEnumerator(config, expect_known);
  ForEachEnumerator(volume, expect_known);
  volume.set_mask_adjacency(static_cast<v1::MaskAdjacency>(99));
  EXPECT_NE(JobRequestOf(config, {}).status().message().find("unknown"), std::string::npos);
}

TEST(RequestEnumerators, OfJobsAreAllKnown) {
  v1::CreateJobRequest job;
  ForEachEnumerator(job, [&](const auto& /*field*/, const auto& enumerator) {
    ExpectKnown(NewJobOf(job).status(), enumerator.full_name());
  });
  std::set<v1::JobState> told;
  for (const JobState state : ValuesOf<JobState>()) {
    told.insert(ToMessage(state));
    v1::ListJobsRequest request;
    request.add_states(ToMessage(state));
    const auto query = QueryOf(request);
    ASSERT_TRUE(query.ok()) << query.status();
    EXPECT_EQ(query->states, std::vector{state});
  }
  EXPECT_FALSE(told.contains(v1::JOB_STATE_UNSPECIFIED));
  EXPECT_EQ(told.size(), static_cast<size_t>(v1::JobState_descriptor()->value_count() - 1));
}

}  // namespace
}  // namespace bccskel::server
