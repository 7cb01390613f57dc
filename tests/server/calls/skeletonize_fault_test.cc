#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "proto/wire/error_details.h"
#include "tests/server/support/call_fault.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

namespace bccskel::skeletonize_fault {
namespace {

using absl::StatusCode;
using test::ConfigRequest, test::Converse, test::InConfig, test::InVolume, test::kFaultName;
using Request = v1::SkeletonizeRequest;
using Requests = std::vector<Request>;
using Fault = test::CallFault<Request>;

constexpr uint64_t kMaxVolumeBytes = 3 << 20, kMaxBricks = 1 << 16, kMaxBytes = 200 << 20;

const test::DeclaredVolume& Torus() { return test::SmallTorusPlanes(); }
Requests Good() { return RequestsFor(Torus(), 10'000); }

std::vector<Fault> ByteFaults() {
  return {
      {"MoreThanDeclared", InVolume([](auto& volume) { volume.set_size_bytes(15'000); }),
       "chunk.data", "VOLUME_SIZE"},
      {"MoreBricksThanDeclared", InVolume([](auto& volume) { volume.set_max_bricks(2); }),
       "chunk.data", "VOLUME_INVALID"},
      {"AnotherEncodingThanDeclared",
       InVolume([](auto& volume) { volume.set_encoding(v1::VOLUME_ENCODING_OPENEXR); }),
       "chunk.data", "VOLUME_INVALID"},
  };
}

std::vector<Fault> DeclarationFaults() {
  const auto unknown = [](int value) { return static_cast<v1::VolumeEncoding>(value); };
  return {
      {"NoEncoding", InVolume([](auto& volume) { volume.clear_encoding(); }),
       "config.volume.encoding"},
      {"UnknownEncoding", InVolume([=](auto& volume) { volume.set_encoding(unknown(99)); }),
       "config.volume.encoding"},
      {"UnknownCompression", InVolume([](auto& volume) {
         volume.set_compression(static_cast<v1::VolumeCompression>(77));
       }),
       "config.volume.compression"},
      {"NoVolume", InConfig([](auto& config) { config.clear_volume(); }), "config.volume.encoding"},
      {"NoExtent", InVolume([](auto& volume) { volume.clear_extent(); }),
       "config.volume.extent.nx"},
      {"FlatExtent", InVolume([](auto& volume) { volume.mutable_extent()->set_nz(0); }),
       "config.volume.extent.nz"},
      {"HugeExtent", InVolume([](auto& volume) { volume.mutable_extent()->set_ny(~0u); }),
       "config.volume.extent.ny"},
      {"TwoSpacings", InVolume([](auto& volume) {
         volume.mutable_placement()->mutable_spacing()->Resize(2, 1.0);
       }),
       "config.volume.placement.spacing"},
      {"SkewAxes", InVolume([](auto& volume) {
         auto& direction = *volume.mutable_placement()->mutable_direction();
         direction.Resize(9, 0);
         for (const int n : {0, 1, 4, 8}) direction.Set(n, 1);
       }),
       "config.volume.placement"},
      {"NoSize", InVolume([](auto& volume) { volume.clear_size_bytes(); }),
       "config.volume.size_bytes"},
      {"WrongSizeForTheExtent", InVolume([](auto& volume) { volume.set_size_bytes(1 << 30); }),
       "config.volume.size_bytes"},
      {"BricksWithoutTheirNumber", InVolume([](auto& volume) {
         volume.set_encoding(v1::VOLUME_ENCODING_BRICKS);
         volume.clear_max_bricks();
       }),
       "config.volume.max_bricks"},
  };
}

std::vector<Fault> OptionFaults() {
  const auto options = [](auto change) {
    return InConfig([change](auto& config) { change(*config.mutable_options()); });
  };
  return {
      {"NegativeThreads", InConfig([](auto& config) { config.set_threads(-1); }), "config.threads"},
      {"UnknownThinVolume", InConfig([](auto& config) {
         config.set_thin_volume_return(static_cast<v1::ThinVolumeReturn>(9));
       }),
       "config.thin_volume_return"},
      {"UnknownStubble",
       options([](auto& o) { o.set_stubble_policy(static_cast<v1::StubblePolicy>(9)); }),
       "config.options.stubble_policy"},
      {"UnknownCleanup",
       options([](auto& o) { o.set_thinness_cleanup(static_cast<v1::ThinnessCleanup>(9)); }),
       "config.options.thinness_cleanup"},
      {"ShellWidthNotANumber", options([](auto& o) { o.set_shell_width(std::nan("")); }),
       "config.options"},
      {"ThinShells", options([](auto& o) { o.set_shell_width(0.1); }), "config.options"},
      {"NegativeLastShell", options([](auto& o) { o.set_last_shell(-3); }), "config.options"},
      {"UnevenKeepColumns", options([](auto& o) { o.mutable_keep()->add_x(1); }),
       "config.options.keep"},
  };
}

// Refused from the declaration alone: no byte is sent, so none can have been needed.
std::vector<Fault> SizeFaults() {
  const auto planes_of = [](uint32_t cells) {
    return [cells](Requests& requests) {
      test::DeclaredVolume volume = Torus();
      volume.declaration.clear_max_bricks();
      for (auto set :
           {&v1::LatticeExtent::set_nx, &v1::LatticeExtent::set_ny, &v1::LatticeExtent::set_nz}) {
        (volume.declaration.mutable_extent()->*set)(cells);
      }
      volume.declaration.set_size_bytes(uint64_t{8} * cells * cells * ((cells + 31) / 32));
      requests = {ConfigRequest(volume)};
    };
  };
  const auto bricks = [](uint64_t count, uint64_t size_bytes) {
    return [count, size_bytes](Requests& requests) {
      test::DeclaredVolume volume = test::Declare(test::SmallTorus(), VolumeEncoding::kBricks);
      volume.declaration.mutable_extent()->set_nx(4'000'000);
      volume.declaration.set_max_bricks(count);
      volume.declaration.set_size_bytes(size_bytes);
      requests = {ConfigRequest(volume)};
    };
  };
  const std::string too_large = "VOLUME_TOO_LARGE";
  const auto exhausted = StatusCode::kResourceExhausted;
  return {
      {"MoreBytesThanTheServerTakes", planes_of(256), "max_volume_bytes", too_large, exhausted},
      {"MoreBricksThanTheServerTakes", bricks(kMaxBricks + 1, 1000), "max_bricks", too_large,
       exhausted},
      {"MoreMemoryThanTheServerHas", bricks(kMaxBricks, 1000), "max_admitted_bytes", too_large,
       exhausted},
      {"AVolumeOfPetabytes", planes_of(4'000'000), "max_bricks", too_large, exhausted},
  };
}

class FaultTest : public testing::TestWithParam<Fault> {
 protected:
  static void SetUpTestSuite() {
    server::ServerConfig config = test::SmallServer();
    config.limits.max_volume_bytes = kMaxVolumeBytes;
    config.limits.volume.max_bricks = kMaxBricks;
    config.limits.max_bytes = kMaxBytes;
    server_ = test::StartServer(config);
  }
  static void TearDownTestSuite() { server_.reset(); }

  static std::unique_ptr<server::Server> server_;
};
std::unique_ptr<server::Server> FaultTest::server_;

TEST_P(FaultTest, IsToldWithCodeReasonAndFieldAndCostsNothing) {
  ExpectFault(GetParam(), Good(), *server_);
  EXPECT_TRUE(SkeletonOf(Converse(*server_, Good())).ok()) << "the server must go on";
}

INSTANTIATE_TEST_SUITE_P(Stream, FaultTest, testing::ValuesIn(test::StreamFaults<Request>()),
                         kFaultName);
INSTANTIATE_TEST_SUITE_P(Bytes, FaultTest, testing::ValuesIn(ByteFaults()), kFaultName);
INSTANTIATE_TEST_SUITE_P(Declaration, FaultTest, testing::ValuesIn(DeclarationFaults()),
                         kFaultName);
INSTANTIATE_TEST_SUITE_P(Options, FaultTest, testing::ValuesIn(OptionFaults()), kFaultName);
INSTANTIATE_TEST_SUITE_P(Size, FaultTest, testing::ValuesIn(SizeFaults()), kFaultName);

TEST(SkeletonizeFault, AWrongOffsetIsToldTheCommittedSize) {
  const auto server = test::StartServer();
  Requests requests = Good();
  requests[2].mutable_chunk()->set_offset(12'345);
  const auto replies = Converse(*server, requests);
  const auto info = wire::ErrorInfoOf(replies.status);
  ASSERT_TRUE(info.has_value()) << replies.status;
  EXPECT_EQ(info->metadata().at("committed_size"), "10000");
}

TEST(SkeletonizeFault, AMessageOfFiveMebibytesIsRefusedAndTheServerGoesOn) {
  const auto server = test::StartServer();
  const auto channel = test::ConnectTo(server->address());
  Requests requests = Good();
  requests[1].mutable_chunk()->set_data(std::string(5 << 20, 'x'));
  const auto replies = Converse(channel, requests);
  EXPECT_EQ(replies.status.code(), StatusCode::kResourceExhausted) << replies.status;
  test::WaitUntilIdle(*server);
  EXPECT_TRUE(SkeletonOf(Converse(channel, Good())).ok());
}

TEST(SkeletonizeFault, AFullServerSaysWhenToTryAgain) {
  server::ServerConfig config = test::SmallServer();
  config.limits.max_jobs = 1;
  config.limits.max_queue = 0;
  const auto server = test::StartServer(config);
  const auto channel = test::ConnectTo(server->address());
  test::RawCall first(channel);
  ASSERT_TRUE(first.Send(ConfigRequest(Torus())));
  ASSERT_TRUE(first.Receive().has_value());
  const absl::Status refused = Converse(channel, Good()).status;
  EXPECT_EQ(refused.code(), StatusCode::kUnavailable);
  EXPECT_EQ(wire::ErrorInfoOf(refused)->reason(), "QUEUE_FULL");
  EXPECT_TRUE(wire::RetryDelayOf(refused).has_value());
  first.Cancel();
  test::WaitUntilIdle(*server);
  EXPECT_TRUE(SkeletonOf(Converse(channel, Good())).ok());
}

}  // namespace
}  // namespace bccskel::skeletonize_fault
