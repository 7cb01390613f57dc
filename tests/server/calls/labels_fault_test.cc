#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "proto/wire/error_details.h"
#include "tests/server/support/declared_labels.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

namespace bccskel::labels_fault {
namespace {

using absl::StatusCode;
using test::Converse, test::DeclaredLabels;
using Requests = std::vector<v1::SkeletonizeLabelsRequest>;

// What a caller does wrong and what it must hear.
struct Fault {
  std::string name;
  std::function<void(Requests&)> spoil;
  std::string reason = "FIELD_INVALID";
  std::string field = "";  // of BadRequest; QuotaFailure's subject for RESOURCE_EXHAUSTED
  StatusCode code = StatusCode::kInvalidArgument;

  friend std::ostream& operator<<(std::ostream& out, const Fault& fault) {
    return out << fault.name;
  }
};

template <typename Change>
std::function<void(Requests&)> Config(Change change) {
  return [change](Requests& requests) { change(*requests[0].mutable_config()); };
}
template <typename Change>
std::function<void(Requests&)> Volume(Change change) {
  return Config([change](auto& config) { change(*config.mutable_volume()); });
}

std::vector<Fault> StreamFaults() {
  return {
      {"NoRequest", [](Requests& r) { r.clear(); }, "REQUEST_ORDER"},
      {"EmptyRequest", [](Requests& r) { r.assign(1, {}); }, "FIELD_INVALID", "request"},
      {"ChunkBeforeConfig", [](Requests& r) { r.erase(r.begin()); }, "REQUEST_ORDER"},
      {"SecondConfig", [](Requests& r) { r[1] = r[0]; }, "REQUEST_ORDER"},
      {"HalfClosedBeforeFinish", [](Requests& r) { r.pop_back(); }, "VOLUME_TRUNCATED"},
      {"MissingChunk", [](Requests& r) { r.erase(r.end() - 2); }, "VOLUME_SIZE",
       "finish.size_bytes"},
      {"Gap", [](Requests& r) { r[1].mutable_chunk()->set_offset(1); }, "CHUNK_OFFSET", "",
       StatusCode::kOutOfRange},
      {"WrongDigest",
       [](Requests& r) { r.back().mutable_finish()->mutable_sha256()->front() ^= 1; },
       "VOLUME_INVALID", "chunk.data"},
      {"NotZstd", Volume([](auto& v) { v.set_compression(v1::VOLUME_COMPRESSION_ZSTD); }),
       "VOLUME_INVALID", "chunk.data"},
  };
}

std::vector<Fault> DeclarationFaults() {
  return {
      {"NoVolume", Config([](auto& c) { c.clear_volume(); }), "FIELD_INVALID",
       "config.volume.type"},
      {"NoType", Volume([](auto& v) { v.clear_type(); }), "FIELD_INVALID", "config.volume.type"},
      {"UnknownType", Volume([](auto& v) { v.set_type(static_cast<v1::LabelType>(9)); }),
       "FIELD_INVALID", "config.volume.type"},
      {"AnotherType", Volume([](auto& v) { v.set_type(v1::LABEL_TYPE_UINT16); }), "FIELD_INVALID",
       "config.volume.size_bytes"},
      {"UnknownCompression",
       Volume([](auto& v) { v.set_compression(static_cast<v1::VolumeCompression>(7)); }),
       "FIELD_INVALID", "config.volume.compression"},
      {"UnknownAdjacency",
       Volume([](auto& v) { v.set_mask_adjacency(static_cast<v1::MaskAdjacency>(7)); }),
       "FIELD_INVALID", "config.volume.mask_adjacency"},
      {"NoExtent", Volume([](auto& v) { v.clear_extent(); }), "FIELD_INVALID",
       "config.volume.extent.nx"},
      {"TooLongAnAxis", Volume([](auto& v) { v.mutable_extent()->set_nx(3'000'000); }),
       "FIELD_INVALID", "config.volume.extent"},
      {"TwoSpacings",
       Volume([](auto& v) { v.mutable_placement()->mutable_spacing()->Resize(2, 1.0); }),
       "FIELD_INVALID", "config.volume.placement.spacing"},
      {"NoSize", Volume([](auto& v) { v.clear_size_bytes(); }), "FIELD_INVALID",
       "config.volume.size_bytes"},
      {"OneByteTooFew", Volume([](auto& v) { v.set_size_bytes(v.size_bytes() - 1); }),
       "FIELD_INVALID", "config.volume.size_bytes"},
      {"MoreVoxelsThanFit", Volume([](auto& v) { v.set_max_voxels(~uint64_t{0}); }),
       "FIELD_INVALID", "config.volume.max_voxels"},
      {"ALabelLargerThanAll", Volume([](auto& v) { v.set_max_label_voxels(v.max_voxels() + 1); }),
       "FIELD_INVALID", "config.volume.max_label_voxels"},
      {"Background", Config([](auto& c) { c.add_labels(0); }), "FIELD_INVALID", "config.labels"},
      {"NegativeThreads", Config([](auto& c) { c.set_threads(-1); }), "FIELD_INVALID",
       "config.threads"},
      {"ThinShells", Config([](auto& c) { c.mutable_options()->set_shell_width(0.1); }),
       "FIELD_INVALID", "config.options"},
  };
}

std::vector<Fault> BrokenPromises() {
  return {
      {"MoreVoxels", Volume([](auto& v) { v.set_max_voxels(v.max_voxels() - 1); }),
       "VOLUME_INVALID", "chunk.data"},
      {"ALargerLabel", Volume([](auto& v) { v.set_max_label_voxels(v.max_label_voxels() - 1); }),
       "VOLUME_INVALID", "chunk.data"},
      {"MoreRuns", Volume([](auto& v) { v.set_max_runs(v.max_runs() - 1); }), "VOLUME_INVALID",
       "chunk.data"},
      {"MoreLabels", Volume([](auto& v) { v.set_max_labels(4); }), "VOLUME_INVALID", "chunk.data"},
  };
}

// Refused from the declaration alone: no byte is sent, so none can have been needed.
std::vector<Fault> SizeFaults() {
  const auto cube = [](uint32_t edge, uint64_t promise) {
    return [edge, promise](Requests& requests) {
      requests.resize(1);
      v1::LabelVolumeDeclaration& volume = *requests[0].mutable_config()->mutable_volume();
      volume.mutable_extent()->set_nx(edge);
      volume.mutable_extent()->set_ny(edge);
      volume.mutable_extent()->set_nz(edge);
      volume.set_type(v1::LABEL_TYPE_UINT8);
      volume.set_compression(v1::VOLUME_COMPRESSION_ZSTD);
      volume.set_size_bytes(1000);
      volume.set_max_voxels(promise);
      volume.set_max_label_voxels(promise);
      volume.set_max_runs(promise);
    };
  };
  const auto exhausted = [](std::string name, std::function<void(Requests&)> spoil,
                            std::string limit) {
    return Fault{std::move(name), std::move(spoil), "VOLUME_TOO_LARGE", std::move(limit),
                 StatusCode::kResourceExhausted};
  };
  return {
      exhausted("MoreThanMayBeDecoded", cube(2000, 10), "max_decoded_bytes"),
      exhausted("Petabytes", cube(2'000'000, 10), "max_decoded_bytes"),
      exhausted("MoreMemoryThanTheServerHas", cube(500, 0), "max_admitted_bytes"),
      exhausted("MoreRunsThanTheServerHasMemoryFor", cube(500, 100'000'000), "max_admitted_bytes"),
      exhausted(
          "MoreBytesThanTheServerTakes",
          [cube](Requests& requests) {
            cube(500, 10)(requests);
            requests[0].mutable_config()->mutable_volume()->set_size_bytes(100'000'000);
          },
          "max_volume_bytes"),
  };
}

class LabelsFault : public testing::TestWithParam<Fault> {
 protected:
  static void SetUpTestSuite() {
    server::ServerConfig config = test::SmallServer();
    config.limits.max_volume_bytes = 10 << 20;
    config.limits.max_bytes = 200 << 20;
    server_ = test::StartServer(config);
  }
  static void TearDownTestSuite() { server_.reset(); }

  static Requests Good() { return RequestsFor(Declare(test::FiveLabels()), 50'000); }

  static std::unique_ptr<server::Server> server_;
};
std::unique_ptr<server::Server> LabelsFault::server_;

TEST_P(LabelsFault, IsToldWithCodeReasonAndFieldAndCostsNothing) {
  const auto channel = test::ConnectTo(server_->address());
  Requests requests = Good();
  GetParam().spoil(requests);
  const absl::Status status = Converse(channel, requests).status;
  EXPECT_EQ(status.code(), GetParam().code) << status;
  const auto info = wire::ErrorInfoOf(status);
  ASSERT_TRUE(info.has_value()) << status;
  EXPECT_EQ(info->reason(), GetParam().reason) << status;
  if (const auto bad = wire::BadRequestOf(status); bad.has_value()) {
    EXPECT_EQ(bad->field_violations(0).field(), GetParam().field) << status;
  } else if (const auto quota = wire::QuotaFailureOf(status); quota.has_value()) {
    EXPECT_EQ(quota->violations(0).subject(), GetParam().field) << status;
  } else {
    EXPECT_EQ(GetParam().field, "") << status;
  }
  test::WaitUntilIdle(*server_);
  EXPECT_TRUE(SkeletonsOf(Converse(channel, Good())).ok()) << "the server must go on";
}

std::string NameOf(const testing::TestParamInfo<Fault>& test) { return test.param.name; }
INSTANTIATE_TEST_SUITE_P(Stream, LabelsFault, testing::ValuesIn(StreamFaults()), NameOf);
INSTANTIATE_TEST_SUITE_P(Declaration, LabelsFault, testing::ValuesIn(DeclarationFaults()), NameOf);
INSTANTIATE_TEST_SUITE_P(Promise, LabelsFault, testing::ValuesIn(BrokenPromises()), NameOf);
INSTANTIATE_TEST_SUITE_P(Size, LabelsFault, testing::ValuesIn(SizeFaults()), NameOf);

TEST(LabelsTooLarge, ALabelWithMoreBricksThanTheServerTakesIsNamed) {
  server::ServerConfig config = test::SmallServer();
  config.limits.volume.max_bricks = 20;
  const auto server = test::StartServer(config);
  const auto replies =
      Converse(test::ConnectTo(server->address()), RequestsFor(Declare(test::FiveLabels())));
  EXPECT_EQ(replies.status.code(), StatusCode::kResourceExhausted) << replies.status;
  EXPECT_EQ(replies.status.message().find("label 3: "), 0u) << replies.status;
  const auto quota = wire::QuotaFailureOf(replies.status);
  ASSERT_TRUE(quota.has_value());
  EXPECT_EQ(quota->violations(0).subject(), "max_bricks");
}

}  // namespace
}  // namespace bccskel::labels_fault
