#include "server/calls/message_codec.h"

#include <gtest/gtest.h>

#include "proto/wire/options.h"

namespace bccskel::server {
namespace {

std::string Declaration(v1::VolumeEncoding encoding) {
  v1::VolumeDeclaration declaration;
  declaration.set_encoding(encoding);
  declaration.mutable_extent()->set_nx(8);
  declaration.mutable_extent()->set_ny(8);
  declaration.mutable_extent()->set_nz(8);
  for (const double spacing : {1.0, 1.0, 1.0}) {
    declaration.mutable_placement()->add_spacing(spacing);
  }
  declaration.set_size_bytes(64);
  return declaration.SerializeAsString();
}

// What a job for such a volume is remembered by.
std::string OptionsFor(v1::VolumeEncoding encoding, const SkeletonizeOptions& options) {
  const MessageCodec codec({});
  const std::string declaration = Declaration(encoding);
  const auto bytes = OptionsBytes(wire::ToMessage(options), v1::THIN_VOLUME_RETURN_OMIT);
  EXPECT_TRUE(bytes.ok()) << bytes.status();
  const auto request = codec.RequestOf(declaration, *bytes);
  EXPECT_TRUE(request.ok()) << request.status();
  return codec.OptionsFor(*request, *bytes);
}

constexpr auto kPlanes = v1::VOLUME_ENCODING_RAW_PLANES;
constexpr auto kMask = v1::VOLUME_ENCODING_CUBIC_MASK;

SkeletonizeOptions WithThreshold(double threshold) { return {.pruning = {.threshold = threshold}}; }

TEST(OptionsForAVolume, AreTheSameForADefaultAndItsValue) {
  EXPECT_EQ(OptionsFor(kPlanes, {}), OptionsFor(kPlanes, WithThreshold(0.45)));
  EXPECT_EQ(OptionsFor(kMask, {}), OptionsFor(kMask, WithThreshold(0.45)));
}

TEST(OptionsForAVolume, TellAMaskFromALatticeVolumeOfTheSamePoints) {
  EXPECT_NE(OptionsFor(kPlanes, {}), OptionsFor(kMask, {}));
}

TEST(OptionsForAVolume, AreTheSameWhereNothingIsPruned) {
  SkeletonizeOptions kernel, pruned;
  kernel.thinning.kind = pruned.thinning.kind = SkeletonKind::kKernel;
  pruned.pruning = {.rule = PruningRule::kLength, .threshold = 3};
  EXPECT_EQ(OptionsFor(kPlanes, kernel), OptionsFor(kPlanes, pruned));
}

}  // namespace
}  // namespace bccskel::server
