#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "proto/wire/error_details.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

namespace bccskel::skeletonize_fault {
namespace {

using absl::StatusCode;
using test::ChunkRequest, test::ConfigRequest, test::Converse, test::FinishRequest;
using Requests = std::vector<v1::SkeletonizeRequest>;

// What a caller does wrong and what it must hear.
struct Fault {
  std::string name;
  std::function<Requests()> requests;
  StatusCode code = StatusCode::kInvalidArgument;
  std::string reason = "FIELD_INVALID";
  std::string field = "";  // of BadRequest; QuotaFailure's subject for RESOURCE_EXHAUSTED

  friend std::ostream& operator<<(std::ostream& out, const Fault& fault) {
    return out << fault.name;
  }
};

constexpr uint64_t kMaxVolumeBytes = 3 << 20, kMaxBricks = 1 << 16, kMaxBytes = 200 << 20;

const test::DeclaredVolume& Torus() { return test::SmallTorusPlanes(); }
Requests Good() { return RequestsFor(Torus(), 10'000); }

// The good conversation with a change to its config.
template <typename Change>
std::function<Requests()> Config(Change change) {
  return [change] {
    Requests requests = Good();
    change(*requests[0].mutable_config());
    return requests;
  };
}

template <typename Change>
std::function<Requests()> Declaration(Change change) {
  return Config([change](v1::SkeletonizeConfig& config) { change(*config.mutable_volume()); });
}

// With a change to the request at `place`, from the end where negative.
template <typename Change>
std::function<Requests()> At(int place, Change change) {
  return [place, change] {
    Requests requests = Good();
    change(requests[static_cast<size_t>(place < 0 ? static_cast<int>(requests.size()) + place
                                                  : place)]);
    return requests;
  };
}

std::vector<Fault> OrderFaults() {
  return {
      {"NoRequest", [] { return Requests(); }, StatusCode::kInvalidArgument, "REQUEST_ORDER"},
      {"EmptyRequest", [] { return Requests(1); }, StatusCode::kInvalidArgument, "FIELD_INVALID",
       "request"},
      {"ChunkBeforeConfig", [] { return Requests{ChunkRequest(0, "x")}; },
       StatusCode::kInvalidArgument, "REQUEST_ORDER"},
      {"FinishBeforeConfig", [] { return Requests{FinishRequest(Torus())}; },
       StatusCode::kInvalidArgument, "REQUEST_ORDER"},
      {"SecondConfig",
       [] {
         return Requests{ConfigRequest(Torus()), ConfigRequest(Torus())};
       },
       StatusCode::kInvalidArgument, "REQUEST_ORDER"},
      {"HalfClosedBeforeFinish",
       [] {
         Requests requests = Good();
         requests.pop_back();
         return requests;
       },
       StatusCode::kInvalidArgument, "VOLUME_TRUNCATED"},
      {"HalfClosedInTheMiddle",
       [] {
         Requests requests = Good();
         requests.resize(3);
         return requests;
       },
       StatusCode::kInvalidArgument, "VOLUME_TRUNCATED"},
  };
}

std::vector<Fault> ByteFaults() {
  return {
      {"MissingChunk",
       [] {
         Requests requests = Good();
         requests.erase(requests.end() - 2);
         return requests;
       },
       StatusCode::kInvalidArgument, "VOLUME_SIZE", "finish.size_bytes"},
      {"FinishWithAnotherSize", At(-1, [](auto& r) { r.mutable_finish()->set_size_bytes(7); }),
       StatusCode::kInvalidArgument, "VOLUME_SIZE", "finish.size_bytes"},
      {"MoreThanDeclared", Declaration([](auto& volume) { volume.set_size_bytes(15'000); }),
       StatusCode::kInvalidArgument, "VOLUME_SIZE", "chunk.data"},
      {"ChunkOverOneMebibyte",
       At(1, [](auto& r) { r.mutable_chunk()->set_data(std::string((1 << 20) + 1, 'x')); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "chunk.data"},
      {"Gap", At(2, [](auto& r) { r.mutable_chunk()->set_offset(10'001); }),
       StatusCode::kOutOfRange, "CHUNK_OFFSET"},
      {"Overlap", At(2, [](auto& r) { r.mutable_chunk()->set_offset(0); }), StatusCode::kOutOfRange,
       "CHUNK_OFFSET"},
      {"WrongDigest", At(-1, [](auto& r) { r.mutable_finish()->mutable_sha256()->front() ^= 1; }),
       StatusCode::kInvalidArgument, "VOLUME_INVALID", "chunk.data"},
      {"ShortDigest", At(-1, [](auto& r) { r.mutable_finish()->mutable_sha256()->pop_back(); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "finish.sha256"},
      {"MoreBricksThanDeclared", Declaration([](auto& volume) { volume.set_max_bricks(2); }),
       StatusCode::kInvalidArgument, "VOLUME_INVALID", "chunk.data"},
      {"AnotherEncodingThanDeclared",
       Declaration([](auto& volume) { volume.set_encoding(v1::VOLUME_ENCODING_OPENEXR); }),
       StatusCode::kInvalidArgument, "VOLUME_INVALID", "chunk.data"},
  };
}

std::vector<Fault> DeclarationFaults() {
  const auto unknown = [](int value) { return static_cast<v1::VolumeEncoding>(value); };
  return {
      {"NoEncoding", Declaration([](auto& volume) { volume.clear_encoding(); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.encoding"},
      {"UnknownEncoding", Declaration([=](auto& volume) { volume.set_encoding(unknown(99)); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.encoding"},
      {"UnknownCompression", Declaration([](auto& volume) {
         volume.set_compression(static_cast<v1::VolumeCompression>(77));
       }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.compression"},
      {"NoVolume", Config([](auto& config) { config.clear_volume(); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.encoding"},
      {"NoExtent", Declaration([](auto& volume) { volume.clear_extent(); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.extent.nx"},
      {"FlatExtent", Declaration([](auto& volume) { volume.mutable_extent()->set_nz(0); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.extent.nz"},
      {"HugeExtent", Declaration([](auto& volume) { volume.mutable_extent()->set_ny(~0u); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.extent.ny"},
      {"TwoSpacings", Declaration([](auto& volume) {
         volume.mutable_placement()->mutable_spacing()->Resize(2, 1.0);
       }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.placement.spacing"},
      {"SkewAxes", Declaration([](auto& volume) {
         auto& direction = *volume.mutable_placement()->mutable_direction();
         direction.Resize(9, 0);
         for (const int n : {0, 1, 4, 8}) direction.Set(n, 1);
       }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.placement"},
      {"NoSize", Declaration([](auto& volume) { volume.clear_size_bytes(); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.size_bytes"},
      {"WrongSizeForTheExtent", Declaration([](auto& volume) { volume.set_size_bytes(1 << 30); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.size_bytes"},
      {"BricksWithoutTheirNumber", Declaration([](auto& volume) {
         volume.set_encoding(v1::VOLUME_ENCODING_BRICKS);
         volume.clear_max_bricks();
       }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.volume.max_bricks"},
  };
}

std::vector<Fault> OptionFaults() {
  const auto options = [](auto change) {
    return Config([change](auto& config) { change(*config.mutable_options()); });
  };
  return {
      {"NegativeThreads", Config([](auto& config) { config.set_threads(-1); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.threads"},
      {"UnknownThinVolume", Config([](auto& config) {
         config.set_thin_volume_return(static_cast<v1::ThinVolumeReturn>(9));
       }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.thin_volume_return"},
      {"UnknownStubble",
       options([](auto& o) { o.set_stubble_policy(static_cast<v1::StubblePolicy>(9)); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.options.stubble_policy"},
      {"UnknownCleanup",
       options([](auto& o) { o.set_thinness_cleanup(static_cast<v1::ThinnessCleanup>(9)); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.options.thinness_cleanup"},
      {"ShellWidthNotANumber", options([](auto& o) { o.set_shell_width(std::nan("")); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.options"},
      {"ThinShells", options([](auto& o) { o.set_shell_width(0.1); }), StatusCode::kInvalidArgument,
       "FIELD_INVALID", "config.options"},
      {"NegativeLastShell", options([](auto& o) { o.set_last_shell(-3); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.options"},
      {"UnevenKeepColumns", options([](auto& o) { o.mutable_keep()->add_x(1); }),
       StatusCode::kInvalidArgument, "FIELD_INVALID", "config.options.keep"},
  };
}

// Refused from the declaration alone: no byte is sent, so none can have been needed.
std::vector<Fault> SizeFaults() {
  const auto planes_of = [](uint32_t cells) {
    return [cells] {
      test::DeclaredVolume volume = Torus();
      volume.declaration.clear_max_bricks();
      for (auto set :
           {&v1::LatticeExtent::set_nx, &v1::LatticeExtent::set_ny, &v1::LatticeExtent::set_nz}) {
        (volume.declaration.mutable_extent()->*set)(cells);
      }
      volume.declaration.set_size_bytes(uint64_t{8} * cells * cells * ((cells + 31) / 32));
      return Requests{ConfigRequest(volume)};
    };
  };
  const auto bricks = [](uint64_t count, uint64_t size_bytes) {
    return [count, size_bytes] {
      test::DeclaredVolume volume = test::Declare(test::SmallTorus(), VolumeEncoding::kBricks);
      volume.declaration.mutable_extent()->set_nx(4'000'000);
      volume.declaration.set_max_bricks(count);
      volume.declaration.set_size_bytes(size_bytes);
      return Requests{ConfigRequest(volume)};
    };
  };
  return {
      {"MoreBytesThanTheServerTakes", planes_of(256), StatusCode::kResourceExhausted,
       "VOLUME_TOO_LARGE", "max_volume_bytes"},
      {"MoreBricksThanTheServerTakes", bricks(kMaxBricks + 1, 1000), StatusCode::kResourceExhausted,
       "VOLUME_TOO_LARGE", "max_bricks"},
      {"MoreMemoryThanTheServerHas", bricks(kMaxBricks, 1000), StatusCode::kResourceExhausted,
       "VOLUME_TOO_LARGE", "max_admitted_bytes"},
      {"AVolumeOfPetabytes", planes_of(4'000'000), StatusCode::kResourceExhausted,
       "VOLUME_TOO_LARGE", "max_bricks"},
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
  const auto channel = test::ConnectTo(server_->address());
  const absl::Status status = Converse(channel, GetParam().requests()).status;
  EXPECT_EQ(status.code(), GetParam().code) << status;
  EXPECT_FALSE(status.message().empty());
  const auto info = wire::ErrorInfoOf(status);
  ASSERT_TRUE(info.has_value()) << status;
  EXPECT_EQ(info->reason(), GetParam().reason) << status;
  EXPECT_EQ(info->domain(), "bccskel");
  if (const auto bad = wire::BadRequestOf(status); bad.has_value()) {
    EXPECT_EQ(bad->field_violations(0).field(), GetParam().field);
  } else if (const auto quota = wire::QuotaFailureOf(status); quota.has_value()) {
    EXPECT_EQ(quota->violations(0).subject(), GetParam().field);
  } else {
    EXPECT_EQ(GetParam().field, "");
  }
  test::WaitUntilIdle(*server_);
  EXPECT_TRUE(SkeletonOf(Converse(channel, Good())).ok()) << "the server must go on";
}

std::string NameOf(const testing::TestParamInfo<Fault>& test) { return test.param.name; }
INSTANTIATE_TEST_SUITE_P(Order, FaultTest, testing::ValuesIn(OrderFaults()), NameOf);
INSTANTIATE_TEST_SUITE_P(Bytes, FaultTest, testing::ValuesIn(ByteFaults()), NameOf);
INSTANTIATE_TEST_SUITE_P(Declaration, FaultTest, testing::ValuesIn(DeclarationFaults()), NameOf);
INSTANTIATE_TEST_SUITE_P(Options, FaultTest, testing::ValuesIn(OptionFaults()), NameOf);
INSTANTIATE_TEST_SUITE_P(Size, FaultTest, testing::ValuesIn(SizeFaults()), NameOf);

TEST(SkeletonizeFault, AWrongOffsetIsToldTheCommittedSize) {
  const auto server = test::StartServer();
  Requests requests = Good();
  requests[2].mutable_chunk()->set_offset(12'345);
  const auto replies = Converse(test::ConnectTo(server->address()), requests);
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
