#include <gtest/gtest.h>

#include <random>
#include <string>

#include "proto/wire/error_details.h"
#include "server/decoding/decoding_child.h"
#include "server/errors/call_error.h"
#include "tests/server/decoding/faulty_children.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

// OpenEXR volumes of strangers, over the wire, in a server that decodes them in children.

namespace bccskel {
namespace {

using test::Converse;

test::DeclaredVolume TorusAs(VolumeCompression compression = VolumeCompression::kRle) {
  return test::Declare(test::SmallTorus(), VolumeEncoding::kOpenExr, compression);
}

server::ServerConfig ServerWithChildren() {
  server::ServerConfig config = test::SmallServer();
  config.limits.child_command = server::ThisProgramAsChild();
  return config;
}

std::string WireReasonOf(const absl::Status& status) {
  const auto info = wire::ErrorInfoOf(status);
  return info.has_value() ? info->reason() : "none";
}

absl::Status Send(const server::Server& server, const test::DeclaredVolume& volume) {
  return Converse(server, test::RequestsFor(volume)).status;
}

TEST(DecodingCall, GivesTheSkeletonOfThisProcess) {
  const auto with = test::StartServer(ServerWithChildren());
  const auto without = test::StartServer();
  const auto requests = test::RequestsFor(TorusAs());
  const auto there = SkeletonOf(Converse(*with, requests));
  const auto here = SkeletonOf(Converse(*without, requests));
  ASSERT_TRUE(there.ok()) << there.status();
  ASSERT_TRUE(here.ok()) << here.status();
  EXPECT_EQ(there->sha256, here->sha256);
}

class FaultyChildCall : public testing::TestWithParam<std::string> {};

TEST_P(FaultyChildCall, EndsTheCallAndNotTheServer) {
#if defined(__SANITIZE_ADDRESS__)
  if (GetParam() == "allocate" || GetParam() == "outside") {
    GTEST_SKIP() << "sanitizers need memory and system calls of their own";
  }
#endif
  server::ServerConfig config = test::SmallServer();
  config.limits.child_command = test::ChildWith(GetParam());
  {
    const auto server = test::StartServer(config);
    const absl::Status status = Send(*server, TorusAs());
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_EQ(WireReasonOf(status), "VOLUME_INVALID");
    EXPECT_TRUE(Send(*server, test::SmallTorusPlanes()).ok());
    test::WaitUntilIdle(*server);
  }
  EXPECT_EQ(test::Zombies(), 0);
}

INSTANTIATE_TEST_SUITE_P(Faults, FaultyChildCall, testing::ValuesIn(test::kChildFaults),
                         [](const auto& test) { return test.param; });

TEST(DecodingCall, WithoutAProgramToStartTheCallerIsAskedToComeAgain) {
  server::ServerConfig config = test::SmallServer();
  config.limits.child_command = {"/no/such/program"};
  const auto server = test::StartServer(config);
  const absl::Status status = Send(*server, TorusAs());
  EXPECT_TRUE(absl::IsUnavailable(status)) << status;
  EXPECT_EQ(WireReasonOf(status), "DECODER_BUSY");
  EXPECT_TRUE(wire::RetryDelayOf(status).has_value());
}

TEST(DecodingCall, ABombNeverReachesAChild) {
  const auto server = test::StartServer(ServerWithChildren());
  test::DeclaredVolume bomb = TorusAs(VolumeCompression::kZip);
  bomb.declaration.mutable_extent()->set_nx(1 << 20);
  bomb.declaration.mutable_extent()->set_ny(1 << 20);
  bomb.declaration.mutable_extent()->set_nz(1 << 10);
  const absl::Status status = Send(*server, bomb);
  EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
}

TEST(DecodingCall, DamagedVolumesByTheDozenLeaveNothingBehind) {
  const auto server = test::StartServer(ServerWithChildren());
  const test::DeclaredVolume good = TorusAs(VolumeCompression::kZip);
  ASSERT_TRUE(Send(*server, good).ok());
  test::WaitUntilIdle(*server);
  const size_t descriptors = test::OpenDescriptors();
  std::mt19937 random(11);
  for (int n = 0; n < 24; ++n) {
    test::DeclaredVolume bad = good;
    for (int flips = 0; flips < 4; ++flips) {
      bad.bytes[random() % bad.bytes.size()] ^= static_cast<char>(1 << random() % 8);
    }
    const absl::Status status = Send(*server, bad);
    EXPECT_TRUE(status.ok() || absl::IsInvalidArgument(status)) << status;
  }
  ASSERT_TRUE(Send(*server, good).ok());
  test::WaitUntilIdle(*server);
  EXPECT_LE(test::OpenDescriptors(), descriptors + 4) << "gRPC may keep a few more";
}

}  // namespace
}  // namespace bccskel
