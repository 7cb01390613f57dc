#include "server/admission/admission.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using Usage = Admission::Usage;

TEST(Admission, CountsBytesAndPlaces) {
  Admission admission({.bytes = 100, .places = 3});
  const auto first = admission.Admit("", 60);
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 60, .places = 1}));
  const auto second = admission.Admit("", 40);
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 100, .places = 2}));
}

TEST(Admission, GivesBackWhenATicketIsDestroyed) {
  Admission admission({.bytes = 100, .places = 1});
  { const auto ticket = admission.Admit("", 100); }
  EXPECT_EQ(admission.usage(), Usage());
}

TEST(Admission, ReclaimsFreedMemoryBeforeItCouldExceedTheLimit) {
  int reclaimed = 0;
  Admission admission({.bytes = 100, .places = 9}, [&] { ++reclaimed; });
  { const auto ticket = admission.Admit("", 40); }  // 40 may be kept
  { const auto ticket = admission.Admit("", 60); }  // 40 + 60, then 100
  EXPECT_EQ(reclaimed, 0);
  const auto third = admission.Admit("", 1);
  EXPECT_EQ(reclaimed, 1);
  auto fourth = *admission.Admit("", 99);
  EXPECT_EQ(reclaimed, 1);
  fourth.ShrinkTo(49);
  ASSERT_TRUE(fourth.ResizeTo(50).ok());  // 50 may be kept, and 51 are in use
  EXPECT_EQ(reclaimed, 2);
}

TEST(Admission, ATicketMovesWithoutBeingGivenBackTwice) {
  Admission admission({.bytes = 100, .places = 2});
  Ticket ticket = *admission.Admit("", 70);
  Ticket moved = std::move(ticket);
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 70, .places = 1}));
  moved = *admission.Admit("", 30);
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 30, .places = 1}));
  moved = Ticket();
  EXPECT_EQ(admission.usage(), Usage());
}

TEST(Admission, APartOfATicketCanBeGivenBack) {
  Admission admission({.bytes = 100, .places = 1});
  Ticket ticket = *admission.Admit("", 100);
  ticket.ShrinkTo(10);
  ticket.ShrinkTo(50);
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 10, .places = 1}));
  ticket.LeavePlace();
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 10, .places = 0}));
  ticket = Ticket();
  EXPECT_EQ(admission.usage(), Usage());
}

TEST(Admission, ATicketGrowsWhileThereIsRoom) {
  Admission admission({.bytes = 100, .places = 2});
  Ticket ticket = *admission.Admit("", 10);
  const Ticket other = *admission.Admit("", 50);
  EXPECT_TRUE(ticket.ResizeTo(50).ok());
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 100, .places = 2}));
  const absl::Status busy = ticket.ResizeTo(51);
  EXPECT_EQ(ReasonOf(busy), Reason::kMemoryBusy);
  EXPECT_EQ(NeededBytesOf(busy), 51u) << "of the whole job";
  EXPECT_EQ(ReasonOf(ticket.ResizeTo(101)), Reason::kVolumeTooLarge);
  EXPECT_EQ(ticket.bytes(), 50u) << "a refused ticket stays as it was";
  EXPECT_TRUE(ticket.ResizeTo(5).ok());
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 55, .places = 2}));
}

TEST(Admission, RefusesForGoodWhatCanNeverFit) {
  Admission admission({.bytes = 100, .places = 1});
  const absl::Status status = admission.Admit("", 101).status();
  EXPECT_EQ(ReasonOf(status), Reason::kVolumeTooLarge);
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
}

TEST(Admission, RefusesForNowWhenItIsFull) {
  Admission admission({.bytes = 100, .places = 2});
  const auto first = admission.Admit("", 60);
  const absl::Status memory = admission.Admit("", 60).status();
  EXPECT_EQ(ReasonOf(memory), Reason::kMemoryBusy);
  EXPECT_EQ(memory.code(), absl::StatusCode::kUnavailable);
  const auto second = admission.Admit("", 1);
  const absl::Status places = admission.Admit("", 1).status();
  EXPECT_EQ(ReasonOf(places), Reason::kQueueFull);
  EXPECT_EQ(places.code(), absl::StatusCode::kUnavailable);
}

TEST(Admission, ATenantHasItsOwnLimits) {
  Admission admission({.bytes = 100,
                       .places = 10,
                       .tenants = {.each = {.max_jobs = 2, .max_bytes = 40}, .named = {}}});
  const auto first = admission.Admit("greedy", 30);
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(ReasonOf(admission.Admit("greedy", 20).status()), Reason::kMemoryBusy);
  EXPECT_EQ(ReasonOf(admission.Admit("greedy", 41).status()), Reason::kVolumeTooLarge);
  const auto second = admission.Admit("greedy", 1);
  EXPECT_EQ(ReasonOf(admission.Admit("greedy", 1).status()), Reason::kQueueFull);
  const auto other = admission.Admit("small", 40);
  ASSERT_TRUE(other.ok()) << other.status();
  EXPECT_EQ(admission.usage("greedy"), (Usage{.bytes = 31, .places = 2}));
  EXPECT_EQ(admission.usage("small"), (Usage{.bytes = 40, .places = 1}));
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 71, .places = 3}));
}

TEST(Admission, ANamedTenantMayHaveMore) {
  Admission admission(
      {.bytes = 100,
       .places = 10,
       .tenants = {.each = {.max_bytes = 10}, .named = {{"large", {.max_bytes = 0}}}}});
  EXPECT_FALSE(admission.Admit("small", 11).ok());
  EXPECT_TRUE(admission.Admit("large", 100).ok());
}

TEST(Admission, WithoutACapATenantTakesHalfOfThePlacesThatOthersLeave) {
  Admission admission(
      {.bytes = 100,
       .places = 7,
       .tenants = {.each = {}, .named = {{"capped", {.max_jobs = 7}}, {"a", {}}, {"b", {}}}}});
  std::vector<Ticket> tickets;
  const auto taken = [&](const std::string& tenant) {
    absl::StatusOr<Ticket> ticket = admission.Admit(tenant, 1);
    if (ticket.ok()) {
      tickets.push_back(*std::move(ticket));
      return true;
    }
    EXPECT_EQ(ReasonOf(ticket.status()), Reason::kQueueFull);
    return false;
  };
  for (int n = 0; n < 4; ++n) EXPECT_TRUE(taken("a")) << n;
  EXPECT_FALSE(taken("a"));
  EXPECT_TRUE(taken("b"));
  EXPECT_TRUE(taken("b"));
  EXPECT_FALSE(taken("b"));
  EXPECT_TRUE(taken("capped")) << "a cap of its own is what a tenant may have";
  EXPECT_FALSE(taken("capped"));
}

TEST(Admission, ATenantWithoutOthersMayHaveAllPlaces) {
  Admission admission({.bytes = 100, .places = 3, .tenants = {.each = {}, .named = {{"a", {}}}}});
  std::vector<Ticket> tickets;
  for (int n = 0; n < 3; ++n) {
    absl::StatusOr<Ticket> ticket = admission.Admit("a", 1);
    ASSERT_TRUE(ticket.ok()) << ticket.status();
    tickets.push_back(*std::move(ticket));
  }
}

TEST(Admission, CountsJobsUntilTheirResultsAreLetGoOf) {
  Admission admission({.bytes = 100, .places = 2});
  EXPECT_EQ(admission.jobs(), 0);
  {
    Ticket unread = *admission.Admit("", 60);
    unread.LeavePlace();
    const Ticket moved = std::move(unread);
    const Ticket at_work = *admission.Admit("", 10);
    EXPECT_EQ(admission.usage().places, 1);
    EXPECT_EQ(admission.jobs(), 2);
  }
  EXPECT_EQ(admission.jobs(), 0);
}

TEST(Admission, ATicketKnowsItsTenantWhenItGrowsAndGoes) {
  Admission admission(
      {.bytes = 100, .places = 10, .tenants = {.each = {.max_bytes = 40}, .named = {}}});
  {
    Ticket ticket = *admission.Admit("small", 10);
    EXPECT_TRUE(ticket.ResizeTo(40).ok());
    EXPECT_EQ(ReasonOf(ticket.ResizeTo(41)), Reason::kVolumeTooLarge);
    EXPECT_EQ(admission.usage("small"), (Usage{.bytes = 40, .places = 1}));
  }
  EXPECT_EQ(admission.usage("small"), Usage());
}

TEST(Admission, RefusesEveryoneAfterStopAdmitting) {
  Admission admission({.bytes = 100, .places = 2});
  admission.StopAdmitting();
  const absl::Status status = admission.Admit("", 1).status();
  EXPECT_EQ(ReasonOf(status), Reason::kDraining);
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
}

TEST(Admission, WaitsUntilTheLastTicketIsGone) {
  Admission admission({.bytes = 100, .places = 2});
  admission.WaitUntilEmpty(std::chrono::hours(1));
  auto ticket = admission.Admit("", 7);
  ASSERT_TRUE(ticket.ok());
  admission.WaitUntilEmpty(std::chrono::milliseconds(1));
  EXPECT_EQ(admission.usage(), (Usage{.bytes = 7, .places = 1}));
  ticket->LeavePlace();
  const std::jthread releaser([&ticket] { *ticket = Ticket(); });
  admission.WaitUntilEmpty(std::chrono::hours(1));
  EXPECT_EQ(admission.usage(), Usage());
}

}  // namespace
}  // namespace bccskel::server
