#include <gtest/gtest.h>

#include <future>
#include <utility>

#include "client/skeletonize_client.h"
#include "core/digest/sha256.h"
#include "core/import/shapes/shapes.h"
#include "proto/wire/error_details.h"
#include "tests/client/support/fake_server.h"

// One attempt over a real channel, against a server that may lie.

namespace bccskel::client {
namespace {

using Replies = std::vector<v1::SkeletonizeResponse>;

Stub::Clock::time_point Soon() { return Stub::Clock::now() + std::chrono::minutes(2); }

// A torus with its skeleton, computed once.
const SkeletonizeResult& Torus() {
  static const SkeletonizeResult result =
      *Skeletonize(*GenerateShape(Shape::kTorus, {.points = 5000}), {}, {});
  return result;
}

EncodedVolume SomeVolume() {
  return *EncodeForSending(*GenerateShape(Shape::kTorus, {.points = 5000}), VolumeEncoding::kBricks,
                           {});
}

// What the client makes of an honest server's replies after `damage` has been at them.
absl::StatusOr<SkeletonizeResult> ResultAfter(const std::function<void(Replies&)>& damage) {
  const FakeServer server([&](grpc::ServerContext&, FakeServer::Stream& stream) {
    Replies replies = RepliesFor(Torus());
    damage(replies);
    // The first reply is due before the volume, whatever it is.
    v1::SkeletonizeRequest config;
    stream.Read(&config);
    for (const v1::SkeletonizeResponse& reply : replies) stream.Write(reply);
    for (v1::SkeletonizeRequest rest; stream.Read(&rest);) continue;
    return grpc::Status::OK;
  });
  return MakeGrpcStub(server.address())
      ->Skeletonize(SomeVolume(), {.thin_volume = ThinVolume::kReturn}, Soon());
}

v1::SkeletonizeResponse& Summary(Replies& replies) { return replies.back(); }
v1::SkeletonizeResponse& Thin(Replies& replies) { return replies[replies.size() - 2]; }
v1::SkeletonizeResponse& FirstChunk(Replies& replies) { return replies[2]; }

TEST(GrpcStubTest, AssemblesTheSameResultAsThePipeline) {
  const auto result = ResultAfter([](Replies&) {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->graph, Torus().graph);
  EXPECT_EQ(result->thin, Torus().thin);
  EXPECT_EQ(result->certificate, Torus().certificate);
  EXPECT_EQ(result->sha256, Torus().sha256);
}

TEST(GrpcStubTest, SendsTheVolumeInChunksOfTheServersSizeAndFinishesWithItsDigest) {
  const EncodedVolume volume = SomeVolume();
  ReceivedCall received;
  const FakeServer server([&](grpc::ServerContext&, FakeServer::Stream& stream) {
    received = ReadCall(stream);  // checks the offsets and the size of the chunks
    const Replies replies = RepliesFor(Torus());
    for (size_t n = 1; n < replies.size(); ++n) stream.Write(replies[n]);
    return grpc::Status::OK;
  });
  CallOptions options = {.threads = 7};
  options.skeletonize.thinning.last_shell = 5;
  const auto result = MakeGrpcStub(server.address())->Skeletonize(volume, options, Soon());
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(received.bytes, volume.bytes);
  EXPECT_TRUE(received.finished);
  EXPECT_EQ(received.finish.size_bytes(), volume.bytes.size());
  const Sha256Digest digest = Sha256Of(volume.bytes);
  EXPECT_EQ(received.finish.sha256(), std::string(digest.bytes.begin(), digest.bytes.end()));
  EXPECT_EQ(received.config.threads(), 7);
  EXPECT_EQ(received.config.options().last_shell(), 5);
  EXPECT_EQ(received.config.thin_volume_return(), v1::THIN_VOLUME_RETURN_OMIT);
}

TEST(GrpcStubTest, TellsTheShells) {
  const FakeServer server([&](grpc::ServerContext&, FakeServer::Stream& stream) {
    ReadCall(stream);
    const Replies replies = RepliesFor(Torus());
    for (size_t n = 1; n < replies.size(); ++n) stream.Write(replies[n]);
    return grpc::Status::OK;
  });
  std::vector<exec::ShellProgress> shells;
  const CallOptions options = {.on_shell = [&](const auto& shell) { shells.push_back(shell); }};
  ASSERT_TRUE(MakeGrpcStub(server.address())->Skeletonize(SomeVolume(), options, Soon()).ok());
  ASSERT_EQ(shells.size(), 1);
  EXPECT_EQ(shells[0].shell, 1);
  EXPECT_EQ(shells[0].last_shell, 2);
}

// Each damage must be noticed; the name says what a user would otherwise get.
struct Damage {
  const char* name;
  std::function<void(Replies&)> apply;
};

class DamagedStreamTest : public testing::TestWithParam<Damage> {};

TEST_P(DamagedStreamTest, IsDataLoss) {
  const auto result = ResultAfter(GetParam().apply);
  EXPECT_TRUE(absl::IsDataLoss(result.status())) << result.status();
}

INSTANTIATE_TEST_SUITE_P(
    Every, DamagedStreamTest,
    testing::Values(Damage{"no_reply", [](Replies& r) { r.resize(1); }},
                    Damage{"no_summary", [](Replies& r) { r.pop_back(); }},
                    Damage{"not_accepted", [](Replies& r) { r.erase(r.begin()); }},
                    Damage{"accepted_twice", [](Replies& r) { r.insert(r.begin(), r.front()); }},
                    Damage{"chunk_missing", [](Replies& r) { r.erase(r.begin() + 2); }},
                    Damage{"chunk_repeated", [](Replies& r) { r.insert(r.begin() + 2, r[2]); }},
                    Damage{"point_moved",
                           [](Replies& r) {
                             auto& points =
                                 *FirstChunk(r).mutable_skeleton_chunk()->mutable_points();
                             points.set_x(1, points.x(1) + 2);
                           }},
                    Damage{"digest_changed",
                           [](Replies& r) {
                             std::string& digest = *Summary(r).mutable_summary()->mutable_sha256();
                             digest[0] = static_cast<char>(digest[0] ^ 1);
                           }},
                    Damage{"thin_volume_missing", [](Replies& r) { r.erase(r.end() - 2); }},
                    Damage{"thin_volume_shifted",
                           [](Replies& r) { Thin(r).mutable_thin_volume_chunk()->set_offset(1); }},
                    Damage{"thin_volume_cut",
                           [](Replies& r) {
                             Thin(r).mutable_thin_volume_chunk()->mutable_data()->pop_back();
                           }}),
    [](const auto& test) { return test.param.name; });

TEST(GrpcStubTest, KeepsTheServersErrorWithItsDetails) {
  const absl::Status full = wire::WithRetryDelay(
      wire::WithReason(absl::UnavailableError("64 jobs wait"), "QUEUE_FULL"), absl::Seconds(3));
  const FakeServer server([&](grpc::ServerContext&, FakeServer::Stream&) {
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, std::string(full.message()),
                        wire::ToRpcStatus(full).SerializeAsString());
  });
  const auto result = MakeGrpcStub(server.address())->Skeletonize(SomeVolume(), {}, Soon());
  EXPECT_EQ(result.status(), full);
  EXPECT_EQ(wire::RetryDelayOf(result.status()), absl::Seconds(3));
}

// A server that waits for the end of the call and says whether it was cancelled.
FakeServer::Script WaitForCancel(std::promise<void>& cancelled, std::function<void()> begun) {
  return [&cancelled, begun = std::move(begun)](grpc::ServerContext& context,
                                                FakeServer::Stream& stream) {
    ReadCall(stream);
    begun();
    while (!context.IsCancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    cancelled.set_value();
    return grpc::Status::CANCELLED;
  };
}

TEST(GrpcStubTest, AStopCancelsTheCallOnTheServer) {
  std::promise<void> cancelled;
  std::stop_source source;
  const FakeServer server(WaitForCancel(cancelled, [&source] { source.request_stop(); }));
  const auto result = MakeGrpcStub(server.address())
                          ->Skeletonize(SomeVolume(), {.stop = source.get_token()}, Soon());
  EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
  cancelled.get_future().wait();
}

TEST(GrpcStubTest, AStopBeforeTheCallSendsNothing) {
  std::stop_source source;
  source.request_stop();
  const auto result = MakeGrpcStub("unix:/nowhere")
                          ->Skeletonize(SomeVolume(), {.stop = source.get_token()}, Soon());
  EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
}

TEST(GrpcStubTest, TheDeadlineEndsACallThatTheServerDoesNot) {
  std::promise<void> cancelled;
  const FakeServer server(WaitForCancel(cancelled, [] {}));
  const auto result =
      MakeGrpcStub(server.address())
          ->Skeletonize(SomeVolume(), {}, Stub::Clock::now() + std::chrono::milliseconds(300));
  EXPECT_TRUE(absl::IsDeadlineExceeded(result.status())) << result.status();
  cancelled.get_future().wait();
}

TEST(GrpcStubTest, NobodyListeningIsUnavailable) {
  const auto result = MakeGrpcStub("unix:/nowhere")->Skeletonize(SomeVolume(), {}, Soon());
  EXPECT_TRUE(absl::IsUnavailable(result.status())) << result.status();
}

}  // namespace
}  // namespace bccskel::client
