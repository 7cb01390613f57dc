#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "proto/wire/error_details.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

// Bytes that are not what they claim to be are the caller's error, said with a reason, and never
// the server's end.

namespace bccskel {
namespace {

struct Form {
  const char* name;
  VolumeEncoding encoding;
  VolumeCompression compression;
};

class HostileVolumeTest : public testing::TestWithParam<Form> {
 protected:
  HostileVolumeTest()
      : good_(test::Declare(test::SmallTorus(), GetParam().encoding, GetParam().compression)),
        server_(test::StartServer()),
        channel_(test::ConnectTo(server_->address())) {}

  // Sends other bytes under the good volume's declaration.
  absl::Status Send(const std::string& bytes) {
    test::DeclaredVolume volume = good_;
    volume.bytes = bytes;
    volume.declaration.set_size_bytes(bytes.size());
    return test::Converse(channel_, RequestsFor(volume)).status;
  }

  static void ExpectCallersFault(const absl::Status& status) {
    EXPECT_TRUE(absl::IsInvalidArgument(status) || absl::IsResourceExhausted(status)) << status;
    EXPECT_TRUE(wire::ErrorInfoOf(status).has_value()) << status;
  }

  bool IsPlainPlanes() const {
    return GetParam().encoding == VolumeEncoding::kRawPlanes &&
           GetParam().compression == VolumeCompression::kNone;
  }

  test::DeclaredVolume good_;
  std::unique_ptr<server::Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
};

TEST_P(HostileVolumeTest, CutOffAnywhere) {
  for (size_t part = 1; part < 16; ++part) {
    ExpectCallersFault(Send(good_.bytes.substr(0, good_.bytes.size() * part / 16)));
  }
  ExpectCallersFault(Send(good_.bytes.substr(0, good_.bytes.size() - 1)));
  ExpectCallersFault(Send(good_.bytes.substr(0, 1)));
  test::WaitUntilIdle(*server_);
}

TEST_P(HostileVolumeTest, TooLong) { ExpectCallersFault(Send(good_.bytes + '\0')); }

TEST_P(HostileVolumeTest, Noise) {
  if (IsPlainPlanes()) GTEST_SKIP() << "any bits are planes";
  std::minstd_rand random(5);
  std::string noise(good_.bytes.size(), '\0');
  for (char& byte : noise) byte = static_cast<char>(random());
  ExpectCallersFault(Send(noise));
  ExpectCallersFault(Send(std::string(good_.bytes.size(), '\0')));
  ExpectCallersFault(Send(std::string(good_.bytes.size(), '\xff')));
}

// Flipped bits may still be a volume, just another one.
TEST_P(HostileVolumeTest, FlippedBits) {
  std::minstd_rand random(9);
  for (int n = 0; n < 150; ++n) {
    std::string bytes = good_.bytes;
    // Headers are where the damage is interesting.
    const size_t range = n % 2 == 0 ? std::min<size_t>(bytes.size(), 2000) : bytes.size();
    bytes[random() % range] ^= static_cast<char>(1 << random() % 8);
    if (const absl::Status status = Send(bytes); !status.ok()) ExpectCallersFault(status);
  }
  EXPECT_TRUE(Send(good_.bytes).ok());
  test::WaitUntilIdle(*server_);
}

TEST_P(HostileVolumeTest, AnotherEncodingsBytes) {
  for (const VolumeEncoding other :
       {VolumeEncoding::kOpenExr, VolumeEncoding::kRawPlanes, VolumeEncoding::kBricks}) {
    if (other == GetParam().encoding) continue;
    ExpectCallersFault(Send(test::Declare(test::SmallTorus(), other).bytes));
  }
}

TEST_P(HostileVolumeTest, AnotherExtentThanDeclared) {
  test::DeclaredVolume volume = good_;
  volume.declaration.mutable_extent()->set_nx(good_.declaration.extent().nx() + 1);
  ExpectCallersFault(test::Converse(channel_, RequestsFor(volume)).status);
}

INSTANTIATE_TEST_SUITE_P(
    Encodings, HostileVolumeTest,
    testing::Values(Form{"OpenExrRle", VolumeEncoding::kOpenExr, VolumeCompression::kRle},
                    Form{"OpenExrZip", VolumeEncoding::kOpenExr, VolumeCompression::kZip},
                    Form{"Planes", VolumeEncoding::kRawPlanes, VolumeCompression::kNone},
                    Form{"PlanesZstd", VolumeEncoding::kRawPlanes, VolumeCompression::kZstd},
                    Form{"Bricks", VolumeEncoding::kBricks, VolumeCompression::kNone},
                    Form{"BricksZstd", VolumeEncoding::kBricks, VolumeCompression::kZstd}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace bccskel
