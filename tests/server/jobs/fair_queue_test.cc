#include "server/jobs/fair_queue.h"

#include <gtest/gtest.h>

#include <string>

namespace bccskel::server {
namespace {

using Queue = FairQueue<std::string>;
using std::chrono::seconds;

constexpr Queue::TimePoint kStart{};

JobOrigin Of(const std::string& tenant, JobPriority priority = JobPriority::kNormal) {
  return {.tenant = tenant, .priority = priority};
}

// Everything in the order in which it is taken, each done at once.
std::string OrderOf(Queue& queue) {
  std::string order;
  while (auto next = queue.Take()) {
    order += next->item;
    queue.Done(next->tenant);
  }
  return order;
}

TEST(FairQueue, OneTenantIsServedInOrder) {
  Queue queue;
  for (const char* item : {"a", "b", "c"}) queue.Push(Of("x"), kStart, item);
  EXPECT_EQ(queue.size(), 3u);
  EXPECT_EQ(OrderOf(queue), "abc");
  EXPECT_TRUE(queue.empty());
}

TEST(FairQueue, TenantsTakeTurnsHoweverMuchOneOfThemAsksFor) {
  Queue queue;
  for (int n = 0; n < 6; ++n) queue.Push(Of("greedy"), kStart, "g");
  for (int n = 0; n < 2; ++n) queue.Push(Of("small"), kStart, "s");
  EXPECT_EQ(OrderOf(queue), "gsgsgggg");
}

TEST(FairQueue, AWeightIsTurnsInARound) {
  TenantTable tenants;
  tenants.named["heavy"] = {.weight = 3};
  Queue queue(tenants);
  for (int n = 0; n < 6; ++n) queue.Push(Of("heavy"), kStart, "h");
  for (int n = 0; n < 2; ++n) queue.Push(Of("light"), kStart, "l");
  const std::string order = OrderOf(queue);
  EXPECT_EQ(order.substr(0, 4).find_first_not_of("hl"), std::string::npos);
  EXPECT_EQ(std::ranges::count(order.substr(0, 4), 'h'), 3) << order;
  EXPECT_EQ(std::ranges::count(order, 'l'), 2) << order;
}

TEST(FairQueue, WhoComesBackHasSavedNothingUp) {
  Queue queue;
  for (int n = 0; n < 4; ++n) queue.Push(Of("busy"), kStart, "b");
  for (int n = 0; n < 3; ++n) queue.Done(queue.Take()->tenant);
  for (int n = 0; n < 3; ++n) queue.Push(Of("late"), kStart, "l");
  for (int n = 0; n < 2; ++n) queue.Push(Of("busy"), kStart, "b");
  EXPECT_EQ(OrderOf(queue), "lblblb");
}

TEST(FairQueue, PriorityIsWorthHalfAMinuteOfWaiting) {
  Queue queue;
  queue.Push(Of("x"), kStart, "n");
  queue.Push(Of("x", JobPriority::kHigh), kStart + seconds(29), "h");
  EXPECT_EQ(OrderOf(queue), "hn");
  queue.Push(Of("x"), kStart, "n");
  queue.Push(Of("x", JobPriority::kHigh), kStart + seconds(31), "h");
  EXPECT_EQ(OrderOf(queue), "nh");
}

TEST(FairQueue, LowPriorityIsNotStarvedByAStreamOfHighOnes) {
  Queue queue;
  queue.Push(Of("x", JobPriority::kLow), kStart, "L");
  std::string order;
  for (int second = 0; second < 100; ++second) {
    queue.Push(Of("x", JobPriority::kHigh), kStart + seconds(second), "h");
    const auto next = queue.Take();
    order += next->item;
    queue.Done(next->tenant);
  }
  EXPECT_EQ(order.find('L'), 60u);
}

TEST(FairQueue, PriorityOfOneTenantIsNothingToOthers) {
  Queue queue;
  queue.Push(Of("x"), kStart, "x");
  for (int n = 0; n < 3; ++n) queue.Push(Of("y", JobPriority::kHigh), kStart, "y");
  const std::string order = OrderOf(queue);
  EXPECT_LE(order.find('x'), 1u) << order;
}

TEST(FairQueue, ATenantWithAllItMayHaveIsPassedOver) {
  TenantTable tenants;
  tenants.named["capped"] = {.max_running = 1};
  Queue queue(tenants);
  for (int n = 0; n < 2; ++n) queue.Push(Of("capped"), kStart, "c");
  queue.Push(Of("other"), kStart, "o");
  EXPECT_EQ(queue.Take()->item, "c");
  EXPECT_EQ(queue.Take()->item, "o");
  EXPECT_FALSE(queue.Has());
  EXPECT_FALSE(queue.Take().has_value());
  queue.Done("capped");
  EXPECT_EQ(queue.Take()->item, "c");
}

TEST(FairQueue, LimitsMayChangeWhileItIsInUse) {
  TenantTable tenants;
  tenants.each.max_running = 1;
  Queue queue(tenants);
  for (int n = 0; n < 2; ++n) queue.Push(Of("x"), kStart, "x");
  EXPECT_TRUE(queue.Take().has_value());
  EXPECT_FALSE(queue.Has());
  queue.SetLimits({});
  EXPECT_TRUE(queue.Has());
}

TEST(FairQueue, TakesOnlyWhatFits) {
  Queue queue;
  queue.Push(Of("x"), kStart, "long");
  queue.Push(Of("x"), kStart, "s");
  const auto is_short = [](const std::string& item) { return item.size() == 1; };
  EXPECT_EQ(queue.Take(is_short)->item, "s");
  EXPECT_FALSE(queue.Take(is_short).has_value());
  EXPECT_TRUE(queue.Has());
}

TEST(FairQueue, WhatIsRemovedIsNeverTaken) {
  Queue queue;
  const auto first = queue.Push(Of("x"), kStart, "a");
  queue.Push(Of("x"), kStart, "b");
  EXPECT_TRUE(queue.Remove(first));
  EXPECT_FALSE(queue.Remove(first));
  EXPECT_EQ(OrderOf(queue), "b");
}

// Durable jobs: the fleet's other servers run some of a tenant's.
TEST(FairQueue, CountsWhatIsAtWorkElsewhere) {
  FairQueue<int, std::chrono::system_clock> queue(
      {.each = {}, .named = {{"capped", {.max_running = 2}}}});
  const std::chrono::system_clock::time_point now;
  queue.Push({.tenant = "capped"}, now, 1);
  queue.SetAtWorkElsewhere({{"capped", 2}, {"other", 9}});
  EXPECT_FALSE(queue.Has());
  queue.SetAtWorkElsewhere({{"capped", 1}});
  EXPECT_EQ(queue.Take()->item, 1);
  queue.Push({.tenant = "capped"}, now, 2);
  EXPECT_FALSE(queue.Has()) << "one here and one elsewhere";
  queue.Done("capped");
  EXPECT_TRUE(queue.Has());
}

TEST(FairQueue, RemovesByPlaceWhateverElseWaits) {
  Queue queue;
  const auto first = queue.Push(Of("x"), kStart, "a");
  const auto second = queue.Push(Of("x"), kStart, "b");
  queue.Push(Of("y"), kStart, "c");
  EXPECT_TRUE(queue.Remove(second));
  EXPECT_FALSE(queue.Remove(second));
  EXPECT_TRUE(queue.Remove(first));
  EXPECT_EQ(queue.size(), 1u);
  EXPECT_EQ(queue.Take()->item, "c");
}

}  // namespace
}  // namespace bccskel::server
