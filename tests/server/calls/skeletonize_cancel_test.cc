#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

// However a call ends, its job ends with it and gives everything back.

namespace bccskel::skeletonize_cancel {
namespace {

using test::Converse, test::RawCall, test::SkeletonOf;

// Seconds of work for two threads.
const test::DeclaredVolume& LargeTorus() {
  static const test::DeclaredVolume torus =
      test::Declare(*GenerateShape(Shape::kTorus, {.points = 6'000'000}), VolumeEncoding::kBricks);
  return torus;
}

void ReceiveUntilProgress(RawCall& call) {
  while (auto response = call.Receive()) {
    if (response->has_shell_progress()) return;
  }
  FAIL() << "the call ended: " << call.Finish();
}

void ExpectServes(const server::Server& server) {
  test::WaitUntilIdle(server);
  const auto replies = Converse(server, RequestsFor(test::SmallTorusPlanes()));
  EXPECT_TRUE(SkeletonOf(replies).ok()) << replies.status;
}

TEST(SkeletonizeCancel, DuringTheUploadFreesThePlace) {
  const auto server = test::StartServer();
  RawCall call(test::ConnectTo(server->address()));
  ASSERT_TRUE(call.Send(ConfigRequest(LargeTorus())));
  ASSERT_TRUE(call.Receive()->has_accepted());
  EXPECT_EQ(server->jobs().admission_usage().places, 1);
  ASSERT_TRUE(call.Send(test::ChunkRequest(0, LargeTorus().bytes.substr(0, 1000))));
  call.Cancel();
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kCancelled);
  ExpectServes(*server);
}

TEST(SkeletonizeCancel, DuringTheComputationFreesThreadsAndMemory) {
  const auto server = test::StartServer();
  RawCall call(test::ConnectTo(server->address()));
  ASSERT_TRUE(call.SendAll(RequestsFor(LargeTorus())));
  ReceiveUntilProgress(call);
  call.Cancel();
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kCancelled);
  ExpectServes(*server);
}

TEST(SkeletonizeCancel, WhileWaitingForATurnFreesThePlace) {
  server::ServerConfig config = test::SmallServer();
  config.limits.max_jobs = 1;
  const auto server = test::StartServer(config);
  RawCall first(test::ConnectTo(server->address())), second(test::ConnectTo(server->address()));
  ASSERT_TRUE(first.SendAll(RequestsFor(LargeTorus())));
  ReceiveUntilProgress(first);
  ASSERT_TRUE(second.SendAll(RequestsFor(LargeTorus())));
  ASSERT_TRUE(second.Receive()->has_accepted());
  second.Cancel();
  EXPECT_EQ(second.Finish().code(), absl::StatusCode::kCancelled);
  first.Cancel();
  EXPECT_EQ(first.Finish().code(), absl::StatusCode::kCancelled);
  ExpectServes(*server);
}

TEST(SkeletonizeCancel, ACallerWhoSendsNothingMeetsItsDeadline) {
  const auto server = test::StartServer();
  RawCall call(test::ConnectTo(server->address()), std::chrono::milliseconds(300));
  ASSERT_TRUE(call.Send(ConfigRequest(LargeTorus())));
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kDeadlineExceeded);
  ExpectServes(*server);
}

// A call that ends before its deadline is tried again with half the time, so that the deadline
// passes during the work however fast the machine is.
TEST(SkeletonizeCancel, APassedDeadlineStopsTheComputation) {
  const auto server = test::StartServer();
  const Volume huge = *GenerateShape(Shape::kBall, {.points = 40'000'000});
  const auto requests = RequestsFor(test::Declare(huge, VolumeEncoding::kBricks), 1 << 20);
  absl::Status end;
  for (auto timeout = std::chrono::milliseconds(1024); end.ok() && timeout.count() > 0;
       timeout /= 2) {
    RawCall call(test::ConnectTo(server->address()), timeout);
    call.SendAll(requests);
    end = call.Finish();
  }
  EXPECT_EQ(end.code(), absl::StatusCode::kDeadlineExceeded);
  ExpectServes(*server);
}

TEST(SkeletonizeCancel, ACallerWhoDropsTheCallEndsTheJob) {
  const auto server = test::StartServer();
  {
    const auto channel = test::ConnectTo(server->address());
    const auto stub = v1::SkeletonizationService::NewStub(channel);
    grpc::ClientContext context;
    const auto stream = stub->Skeletonize(&context);
    for (const auto& request : RequestsFor(LargeTorus())) ASSERT_TRUE(stream->Write(request));
    context.TryCancel();
  }
  ExpectServes(*server);
}

TEST(SkeletonizeCancel, ManyCallsCancelledAtAllTimesLeaveNothingBehind) {
  const auto server = test::StartServer();
  std::vector<std::jthread> callers;
  for (int n = 0; n < 24; ++n) {
    callers.emplace_back([&server, n] {
      RawCall call(test::ConnectTo(server->address()));
      std::jthread canceller([&call, n] {
        std::this_thread::sleep_for(std::chrono::milliseconds(3 * n));
        call.Cancel();
      });
      call.SendAll(RequestsFor(test::SmallTorusPlanes(), 5000));
      const absl::Status end = call.Finish();
      EXPECT_TRUE(end.ok() || absl::IsCancelled(end) || absl::IsInvalidArgument(end)) << end;
    });
  }
  callers.clear();
  ExpectServes(*server);
}

}  // namespace
}  // namespace bccskel::skeletonize_cancel
