#include "server/server.h"

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "bccskel/v1/server_service.grpc.pb.h"
#include "core/import/shapes/shapes.h"
#include "proto/wire/error_details.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

using std::chrono::milliseconds;

// Sends one message to a method whose definition is not at hand, and gives the first reply's bytes.
absl::StatusOr<std::string> CallWithBytes(const std::shared_ptr<grpc::Channel>& channel,
                                          const std::string& method, const std::string& request) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1));
  grpc::CompletionQueue queue;
  grpc::GenericStub stub(channel);
  const auto call = stub.PrepareCall(&context, method, &queue);
  const auto wait = [&queue] {
    void* tag = nullptr;
    bool ok = false;
    return queue.Next(&tag, &ok) && ok;
  };
  const grpc::Slice slice(request);
  grpc::ByteBuffer reply;
  call->StartCall(nullptr);
  bool ok = wait();
  call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
  ok = wait() && ok;
  call->WritesDone(nullptr);
  ok = wait() && ok;
  call->Read(&reply, nullptr);
  ok = wait() && ok;
  grpc::Status status;
  context.TryCancel();  // one reply is enough
  call->Finish(&status, nullptr);
  wait();
  if (!ok) return test::FromGrpcStatus(status);
  grpc::Slice bytes;
  if (!reply.DumpToSingleSlice(&bytes).ok()) return absl::DataLossError("no bytes");
  return std::string(reinterpret_cast<const char*>(bytes.begin()), bytes.size());
}

// grpc.health.v1.HealthCheckRequest{service} and HealthCheckResponse{status}.
absl::StatusOr<std::string> Health(const std::shared_ptr<grpc::Channel>& channel,
                                   const std::string& service) {
  return CallWithBytes(channel, "/grpc.health.v1.Health/Check",
                       '\x0a' + std::string(1, static_cast<char>(service.size())) + service);
}
const std::string kServing = "\x08\x01", kNotServing = "\x08\x02";

TEST(Server, ReportsHealthAsAWholeAndPerService) {
  const auto server = test::StartServer();
  const auto channel = test::ConnectTo(server->address());
  for (const char* service :
       {"", "bccskel.v1.SkeletonizationService", "bccskel.v1.ServerService"}) {
    const auto health = Health(channel, service);
    ASSERT_TRUE(health.ok()) << health.status();
    EXPECT_EQ(*health, kServing) << service;
  }
  EXPECT_FALSE(Health(channel, "no.such.Service").ok());
}

TEST(Server, ReflectionListsItsServices) {
  const auto server = test::StartServer();
  const auto reply = CallWithBytes(  // ServerReflectionRequest{list_services = "*"}
      test::ConnectTo(server->address()),
      "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", "\x3a\x01*");
  ASSERT_TRUE(reply.ok()) << reply.status();
  EXPECT_THAT(*reply, testing::AllOf(testing::HasSubstr("bccskel.v1.SkeletonizationService"),
                                     testing::HasSubstr("bccskel.v1.ServerService"),
                                     testing::HasSubstr("grpc.health.v1.Health")));
}

TEST(Server, StatesItsLimits) {
  ServerConfig config = test::SmallServer();
  config.limits.max_queue = 5;
  config.limits.max_volume_bytes = 123'456;
  config.limits.volume.max_bricks = 789;
  const auto server = test::StartServer(config);
  const auto stub = v1::ServerService::NewStub(test::ConnectTo(server->address()));
  grpc::ClientContext context;
  v1::GetCapabilitiesResponse response;
  ASSERT_TRUE(stub->GetCapabilities(&context, {}, &response).ok());
  EXPECT_EQ(response.limits().max_queue(), 5u);
  EXPECT_EQ(response.limits().max_volume_bytes(), 123'456u);
  EXPECT_EQ(response.limits().max_bricks(), 789u);
  EXPECT_EQ(response.limits().max_jobs(), 2u);
  EXPECT_EQ(response.limits().threads(), 2u);
  EXPECT_EQ(response.limits().max_chunk_bytes(), 1u << 20);
  EXPECT_EQ(response.limits().max_message_bytes(), 4u << 20);
  EXPECT_EQ(response.limits().max_decoded_bytes(), uint64_t{4} << 30);
  EXPECT_EQ(response.encodings_size(), 4);
  EXPECT_THAT(response.label_types(),
              testing::ElementsAre(v1::LABEL_TYPE_UINT8, v1::LABEL_TYPE_UINT16,
                                   v1::LABEL_TYPE_UINT32, v1::LABEL_TYPE_UINT64));
  EXPECT_THAT(response.api_versions(), testing::ElementsAre("v1"));
  EXPECT_FALSE(response.server_version().empty());
}

TEST(Server, AnAddressInUseIsRefused) {
  const auto first = test::StartServer();
  ServerConfig config = test::SmallServer();
  config.listen = {first->address()};
  EXPECT_EQ(Server::Start(config).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(Server, AFileInPlaceOfItsSocketStays) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "model.stl";
  std::ofstream(path) << "precious";
  ServerConfig config = test::SmallServer();
  config.listen = {"unix:" + path};
  const absl::Status status = Server::Start(config).status();
  EXPECT_THAT(status.message(), testing::HasSubstr("the path exists and is not a socket"));
  EXPECT_EQ(std::filesystem::file_size(path), 8U);
}

TEST(ServerDrain, WaitsForTheJobsThatWereLetInAndRefusesOthers) {
  const auto server = test::StartServer();
  const auto channel = test::ConnectTo(server->address());
  test::RawCall call(channel);
  ASSERT_TRUE(call.Send(ConfigRequest(test::SmallTorusPlanes())));
  ASSERT_TRUE(call.Receive()->has_accepted());
  std::jthread drain([&server] { server->Drain(); });
  while (Health(channel, "").value_or("") != kNotServing) std::this_thread::yield();
  absl::Status refused;  // health changes first
  do {
    test::RawCall late(channel);
    late.Send(ConfigRequest(test::SmallTorusPlanes()));
    if (late.Receive().has_value()) late.Cancel();
    refused = late.Finish();
  } while (absl::IsCancelled(refused));
  EXPECT_EQ(refused.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(wire::ErrorInfoOf(refused)->reason(), "DRAINING");
  for (auto& request : RequestsFor(test::SmallTorusPlanes())) {
    if (request.has_config()) continue;
    EXPECT_TRUE(call.Send(request));
  }
  EXPECT_TRUE(call.Finish().ok()) << "a job that was let in ends well";
}

TEST(ServerDrain, CutsOffWhatTakesTooLong) {
  ServerConfig config = test::SmallServer();
  config.drain = milliseconds(50);
  const auto server = test::StartServer(config);
  test::RawCall call(test::ConnectTo(server->address()));
  ASSERT_TRUE(call.Send(ConfigRequest(test::SmallTorusPlanes())));
  ASSERT_TRUE(call.Receive()->has_accepted());
  server->Drain();
  const absl::Status end = call.Finish();
  EXPECT_EQ(end.code(), absl::StatusCode::kUnavailable);
  ASSERT_TRUE(wire::ErrorInfoOf(end).has_value()) << end;
  EXPECT_EQ(wire::ErrorInfoOf(end)->reason(), "DRAINING");
  test::WaitUntilIdle(*server);
}

TEST(ServerDrain, EndsWhileTheJobOfADurableCallIsComputed) {
  const test::TemporaryFolder folder;
  ServerConfig config = test::SmallServer();
  config.durable.data_directory = folder / "data";
  config.drain = milliseconds(0);
  auto server = test::StartServer(config);
  test::RawCall call(test::ConnectTo(server->address()));
  const auto torus = GenerateShape(Shape::kTorus, {.points = 12'000'000});
  for (auto& request : RequestsFor(test::Declare(*torus, VolumeEncoding::kRawPlanes))) {
    if (request.has_config()) request.mutable_config()->set_threads(1);
    ASSERT_TRUE(call.Send(request));
  }
  const auto accepted = call.Receive();
  ASSERT_TRUE(accepted.has_value() && accepted->accepted().durable());
  ASSERT_TRUE(call.Receive()->has_shell_progress());
  server->Drain();
  server.reset();
  EXPECT_EQ(wire::ErrorInfoOf(call.Finish())->reason(), "DRAINING");
}

TEST(ServerDrain, AWatchedHealthStatusDoesNotHoldItUp) {
  ServerConfig config = test::SmallServer();
  config.drain = std::chrono::hours(1);
  const auto server = test::StartServer(config);
  const auto channel = test::ConnectTo(server->address());
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  grpc::GenericStub stub(channel);
  const auto watch = stub.PrepareCall(&context, "/grpc.health.v1.Health/Watch", &queue);
  void* tag = nullptr;
  bool ok = false;
  watch->StartCall(nullptr);
  ASSERT_TRUE(queue.Next(&tag, &ok) && ok);
  const grpc::Slice empty;
  watch->WriteLast(grpc::ByteBuffer(&empty, 1), grpc::WriteOptions(), nullptr);
  ASSERT_TRUE(queue.Next(&tag, &ok) && ok);
  grpc::ByteBuffer reply;
  watch->Read(&reply, nullptr);
  ASSERT_TRUE(queue.Next(&tag, &ok) && ok);
  server->Drain();  // an hour, if the watch held it up
  while (ok) {      // the status comes after the last change
    watch->Read(&reply, nullptr);
    ASSERT_TRUE(queue.Next(&tag, &ok));
  }
  grpc::Status status;
  watch->Finish(&status, nullptr);
  queue.Next(&tag, &ok);
}

}  // namespace
}  // namespace bccskel::server
