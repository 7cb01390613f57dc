#include "client/job_messages.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/enum_values.h"

namespace bccskel::client {
namespace {

TEST(JobMessages, KnowEachState) {
  std::set<JobState> known;
  const auto& states = *v1::JobState_descriptor();
  for (int n = 0; n < states.value_count(); ++n) {
    v1::Job message;
    message.set_state(static_cast<v1::JobState>(states.value(n)->number()));
    const JobState state = FromMessage(message).state;
    EXPECT_EQ(state == JobState::kUnknown, message.state() == v1::JOB_STATE_UNSPECIFIED)
        << states.value(n)->name();
    known.insert(state);
  }
  EXPECT_EQ(known.size(), test::ValuesOf<JobState>().size());
  v1::Job newer;
  newer.set_state(static_cast<v1::JobState>(99));
  EXPECT_EQ(FromMessage(newer).state, JobState::kUnknown);
}

TEST(JobMessages, TellEachPriorityAndWhetherToReturnTheThinVolume) {
  std::set<v1::JobPriority> priorities;
  for (const JobPriority priority : test::ValuesOf<JobPriority>()) {
    NewJob job;
    job.priority = priority;
    priorities.insert(ToMessage(job).priority());
  }
  EXPECT_FALSE(priorities.contains(v1::JOB_PRIORITY_UNSPECIFIED));
  EXPECT_EQ(priorities.size(),
            static_cast<size_t>(v1::JobPriority_descriptor()->value_count() - 1));
  EXPECT_EQ(ToMessage(ThinVolume::kReturn), v1::THIN_VOLUME_RETURN_BRICKS);
  EXPECT_EQ(ToMessage(ThinVolume::kOmit), v1::THIN_VOLUME_RETURN_OMIT);
}

}  // namespace
}  // namespace bccskel::client
