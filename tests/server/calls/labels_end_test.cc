#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "tests/server/support/declared_labels.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

// However a call with labels ends, its job ends with it and gives everything back; and a caller who
// does not read holds up nobody.

namespace bccskel {
namespace {

using test::Converse, test::RawLabelsCall;

// Their graphs take several times what a job of one thread may keep.
const test::LabelImage& Nets() {
  static const test::LabelImage nets = test::ManyNets(300);
  return nets;
}

std::unique_ptr<server::Server> ServerWithOneThread() {
  server::ServerConfig config = test::SmallServer();
  config.limits.threads = config.limits.max_jobs = 1;
  config.limits.max_queue = 1;
  return test::StartServer(config);
}

void ReceiveFirstLabel(RawLabelsCall& call, test::LabelsReplies& replies) {
  while (auto response = call.Receive()) {
    replies.responses.push_back(*std::move(response));
    if (replies.responses.back().has_label_summary()) return;
  }
  FAIL() << "the call ended: " << call.Finish();
}

void WaitUntilPaused(const server::Server& server) {
  while (server.jobs().compute_usage() != server::ComputeQueue::Usage()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(server.jobs().admission_usage().places, 1) << "it has ended instead";
}

void ExpectServes(const server::Server& server) {
  const auto replies = Converse(server, RequestsFor(Declare(test::FiveLabels())));
  EXPECT_TRUE(SkeletonsOf(replies).ok()) << replies.status;
}

TEST(LabelsEnd, ASlowReaderKeepsNoThreadAndLosesNothing) {
  const auto server = ServerWithOneThread();
  RawLabelsCall call(test::ConnectTo(server->address()));
  ASSERT_TRUE(call.SendAll(RequestsFor(Declare(Nets(), 2))));
  test::LabelsReplies replies;
  ReceiveFirstLabel(call, replies);
  WaitUntilPaused(*server);
  const uint64_t kept_bytes = server->jobs().admission_usage().bytes;
  ExpectServes(*server);
  while (server->jobs().admission_usage().bytes != kept_bytes) std::this_thread::yield();
  while (auto response = call.Receive()) replies.responses.push_back(*std::move(response));
  replies.status = call.Finish();
  const auto skeletons = SkeletonsOf(replies);
  ASSERT_TRUE(skeletons.ok()) << skeletons.status();
  const auto expected = test::SkeletonsOf(Nets());
  ASSERT_EQ(skeletons->size(), expected.size());
  for (size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ((*skeletons)[n].label, expected[n].label);
    EXPECT_EQ((*skeletons)[n].result.sha256, expected[n].result.sha256);
  }
  test::WaitUntilIdle(*server);
}

TEST(LabelsEnd, CancelWhilePausedFreesMemoryAndPlace) {
  const auto server = ServerWithOneThread();
  RawLabelsCall call(test::ConnectTo(server->address()));
  ASSERT_TRUE(call.SendAll(RequestsFor(Declare(Nets(), 2))));
  test::LabelsReplies replies;
  ReceiveFirstLabel(call, replies);
  WaitUntilPaused(*server);
  call.Cancel();
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kCancelled);
  test::WaitUntilIdle(*server);
  ExpectServes(*server);
}

TEST(LabelsEnd, CancelDuringTheUploadFreesThePlace) {
  const auto server = ServerWithOneThread();
  RawLabelsCall call(test::ConnectTo(server->address()));
  const auto requests = RequestsFor(Declare(Nets(), 2), 1000);
  ASSERT_TRUE(call.Send(requests[0]));
  ASSERT_TRUE(call.Receive()->has_accepted());
  ASSERT_TRUE(call.Send(requests[1]));
  call.Cancel();
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kCancelled);
  test::WaitUntilIdle(*server);
  ExpectServes(*server);
}

TEST(LabelsEnd, CancelAmidTheLabelsFreesThreadsAndMemory) {
  const auto server = test::StartServer();
  RawLabelsCall call(test::ConnectTo(server->address()));
  ASSERT_TRUE(call.SendAll(RequestsFor(Declare(Nets(), 2))));
  test::LabelsReplies replies;
  ReceiveFirstLabel(call, replies);
  call.Cancel();
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kCancelled);
  test::WaitUntilIdle(*server);
  ExpectServes(*server);
}

// Nothing is read, so the job cannot end before the deadline however fast the machine is.
TEST(LabelsEnd, APassedDeadlineEndsAJobWhoseCallerDoesNotRead) {
  const auto server = ServerWithOneThread();
  RawLabelsCall call(test::ConnectTo(server->address()), std::chrono::milliseconds(700));
  call.SendAll(RequestsFor(Declare(Nets(), 2)));
  test::WaitUntilIdle(*server);
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kDeadlineExceeded);
  ExpectServes(*server);
}

TEST(LabelsEnd, CallsCancelledAtAllTimesLeaveNothingBehind) {
  const auto server = test::StartServer();
  std::vector<std::jthread> callers;
  for (int n = 0; n < 16; ++n) {
    callers.emplace_back([&server, n] {
      RawLabelsCall call(test::ConnectTo(server->address()));
      std::jthread canceller([&call, n] {
        std::this_thread::sleep_for(std::chrono::milliseconds(3 * n));
        call.Cancel();
      });
      call.SendAll(RequestsFor(Declare(test::FiveLabels()), 20'000));
      const absl::Status end = call.Finish();
      EXPECT_TRUE(end.ok() || absl::IsCancelled(end) || absl::IsInvalidArgument(end)) << end;
    });
  }
  callers.clear();
  test::WaitUntilIdle(*server);
  ExpectServes(*server);
}

}  // namespace
}  // namespace bccskel
