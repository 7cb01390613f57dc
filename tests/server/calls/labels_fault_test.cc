#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "proto/wire/error_details.h"
#include "tests/server/support/call_fault.h"
#include "tests/server/support/declared_labels.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

namespace bccskel::labels_fault {
namespace {

using absl::StatusCode;
using test::Converse, test::InConfig, test::InVolume, test::kFaultName;
using Request = v1::SkeletonizeLabelsRequest;
using Requests = std::vector<Request>;
using Fault = test::CallFault<Request>;

std::vector<Fault> DeclarationFaults() {
  return {
      {"NoVolume", InConfig([](auto& c) { c.clear_volume(); }), "config.volume.type"},
      {"NoType", InVolume([](auto& v) { v.clear_type(); }), "config.volume.type"},
      {"UnknownType", InVolume([](auto& v) { v.set_type(static_cast<v1::LabelType>(9)); }),
       "config.volume.type"},
      {"AnotherType", InVolume([](auto& v) { v.set_type(v1::LABEL_TYPE_UINT16); }),
       "config.volume.size_bytes"},
      {"UnknownCompression",
       InVolume([](auto& v) { v.set_compression(static_cast<v1::VolumeCompression>(7)); }),
       "config.volume.compression"},
      {"UnknownAdjacency",
       InVolume([](auto& v) { v.set_mask_adjacency(static_cast<v1::MaskAdjacency>(7)); }),
       "config.volume.mask_adjacency"},
      {"NoExtent", InVolume([](auto& v) { v.clear_extent(); }), "config.volume.extent.nx"},
      {"TooLongAnAxis", InVolume([](auto& v) { v.mutable_extent()->set_nx(3'000'000); }),
       "config.volume.extent"},
      {"TwoSpacings",
       InVolume([](auto& v) { v.mutable_placement()->mutable_spacing()->Resize(2, 1.0); }),
       "config.volume.placement.spacing"},
      {"NoSize", InVolume([](auto& v) { v.clear_size_bytes(); }), "config.volume.size_bytes"},
      {"OneByteTooFew", InVolume([](auto& v) { v.set_size_bytes(v.size_bytes() - 1); }),
       "config.volume.size_bytes"},
      {"MoreVoxelsThanFit", InVolume([](auto& v) { v.set_max_voxels(~uint64_t{0}); }),
       "config.volume.max_voxels"},
      {"ALabelLargerThanAll", InVolume([](auto& v) { v.set_max_label_voxels(v.max_voxels() + 1); }),
       "config.volume.max_label_voxels"},
      {"Background", InConfig([](auto& c) { c.add_labels(0); }), "config.labels"},
      {"NegativeThreads", InConfig([](auto& c) { c.set_threads(-1); }), "config.threads"},
      {"ThinShells", InConfig([](auto& c) { c.mutable_options()->set_shell_width(0.1); }),
       "config.options"},
  };
}

std::vector<Fault> BrokenPromises() {
  return {
      {"NotZstd", InVolume([](auto& v) { v.set_compression(v1::VOLUME_COMPRESSION_ZSTD); }),
       "chunk.data", "VOLUME_INVALID"},
      {"MoreVoxels", InVolume([](auto& v) { v.set_max_voxels(v.max_voxels() - 1); }), "chunk.data",
       "VOLUME_INVALID"},
      {"ALargerLabel", InVolume([](auto& v) { v.set_max_label_voxels(v.max_label_voxels() - 1); }),
       "chunk.data", "VOLUME_INVALID"},
      {"MoreRuns", InVolume([](auto& v) { v.set_max_runs(v.max_runs() - 1); }), "chunk.data",
       "VOLUME_INVALID"},
      {"MoreLabels", InVolume([](auto& v) { v.set_max_labels(4); }), "chunk.data",
       "VOLUME_INVALID"},
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
    return Fault{std::move(name), std::move(spoil), std::move(limit), "VOLUME_TOO_LARGE",
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
  ExpectFault(GetParam(), Good(), *server_);
  EXPECT_TRUE(SkeletonsOf(Converse(*server_, Good())).ok()) << "the server must go on";
}

INSTANTIATE_TEST_SUITE_P(Stream, LabelsFault, testing::ValuesIn(test::StreamFaults<Request>()),
                         kFaultName);
INSTANTIATE_TEST_SUITE_P(Declaration, LabelsFault, testing::ValuesIn(DeclarationFaults()),
                         kFaultName);
INSTANTIATE_TEST_SUITE_P(Promise, LabelsFault, testing::ValuesIn(BrokenPromises()), kFaultName);
INSTANTIATE_TEST_SUITE_P(Size, LabelsFault, testing::ValuesIn(SizeFaults()), kFaultName);

TEST(LabelsTooLarge, ALabelWithMoreBricksThanTheServerTakesIsNamed) {
  server::ServerConfig config = test::SmallServer();
  config.limits.volume.max_bricks = 20;
  const auto server = test::StartServer(config);
  const auto replies = Converse(*server, RequestsFor(Declare(test::FiveLabels())));
  EXPECT_EQ(replies.status.code(), StatusCode::kResourceExhausted) << replies.status;
  EXPECT_EQ(replies.status.message().find("label 3: "), 0u) << replies.status;
  const auto quota = wire::QuotaFailureOf(replies.status);
  ASSERT_TRUE(quota.has_value());
  EXPECT_EQ(quota->violations(0).subject(), "max_bricks");
}

}  // namespace
}  // namespace bccskel::labels_fault
