#include "server/jobs/volume_receiver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/import/shapes/shapes.h"
#include "core/io/volume_encoder.h"

namespace bccskel::server {
namespace {

Volume Torus() { return *GenerateShape(Shape::kTorus, {.points = 20'000}); }

std::string Encode(const Volume& volume, VolumeEncoding encoding) {
  const auto compression =
      encoding == VolumeEncoding::kOpenExr ? VolumeCompression::kRle : VolumeCompression::kNone;
  return *EncodeVolume(volume, {.encoding = encoding, .compression = compression});
}

VolumeHeader Declare(const Volume& volume, VolumeEncoding encoding) {
  return *CompleteVolumeHeader({.encoding = encoding,
                                .compression = VolumeCompression::kNone,
                                .extent = volume.extent(),
                                .placement = volume.placement(),
                                .declared_bricks = volume.brick_count()},
                               VolumeLimits());
}

// Feeds the bytes in pieces and finishes.
absl::StatusOr<Volume> TakeIn(const VolumeHeader& declared, const std::string& bytes, size_t piece,
                              const std::optional<Sha256Digest>& expected = std::nullopt) {
  VolumeReceiver receiver(declared, bytes.size(), VolumeLimits());
  for (size_t offset = 0; offset < bytes.size(); offset += piece) {
    const std::string_view rest = std::string_view(bytes).substr(offset);
    if (absl::Status s = receiver.Append(rest.substr(0, piece)); !s.ok()) return s;
  }
  return receiver.Finish(expected, exec::Context());
}

class VolumeReceiverRoundTrip : public testing::TestWithParam<VolumeEncoding> {};

TEST_P(VolumeReceiverRoundTrip, GivesTheVolumeHoweverItIsCut) {
  const Volume torus = Torus();
  const std::string bytes = Encode(torus, GetParam());
  for (size_t piece : {size_t{100}, size_t{65'536}, bytes.size()}) {
    const auto volume = TakeIn(Declare(torus, GetParam()), bytes, piece, Sha256Of(bytes));
    ASSERT_TRUE(volume.ok()) << volume.status();
    EXPECT_TRUE(*volume == torus);
  }
}

TEST_P(VolumeReceiverRoundTrip, RefusesAnotherDigest) {
  const Volume torus = Torus();
  const std::string bytes = Encode(torus, GetParam());
  const auto volume = TakeIn(Declare(torus, GetParam()), bytes, 65'536, Sha256Of("other"));
  EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(std::string(volume.status().message()).find(Sha256Of(bytes).Hex()), std::string::npos);
}

TEST_P(VolumeReceiverRoundTrip, RefusesTruncatedBytes) {
  const Volume torus = Torus();
  std::string bytes = Encode(torus, GetParam());
  bytes.resize(bytes.size() / 2);
  EXPECT_EQ(TakeIn(Declare(torus, GetParam()), bytes, 65'536).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST_P(VolumeReceiverRoundTrip, RefusesMoreBricksThanTheCallerDeclared) {
  const Volume torus = Torus();
  VolumeHeader declared = Declare(torus, GetParam());
  declared.declared_bricks = declared.max_bricks = torus.brick_count() - 1;
  EXPECT_EQ(TakeIn(declared, Encode(torus, GetParam()), 65'536).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST_P(VolumeReceiverRoundTrip, NoBytesAtAllAreNotAVolume) {
  EXPECT_EQ(TakeIn(Declare(Torus(), GetParam()), "", 1).status().code(),
            absl::StatusCode::kInvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(All, VolumeReceiverRoundTrip,
                         testing::Values(VolumeEncoding::kOpenExr, VolumeEncoding::kRawPlanes,
                                         VolumeEncoding::kBricks),
                         [](const auto& info) {
                           std::string name(VolumeEncodingName(info.param));
                           name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
                           return name;
                         });

TEST(VolumeReceiver, RefusesAnotherExtentThanTheDeclaredOne) {
  const Volume torus = Torus();
  for (VolumeEncoding encoding : {VolumeEncoding::kOpenExr, VolumeEncoding::kBricks}) {
    VolumeHeader declared = Declare(torus, encoding);
    ++declared.extent.nx;
    const auto volume = TakeIn(declared, Encode(torus, encoding), 65'536);
    EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(std::string(volume.status().message()).find("declared"), std::string::npos);
  }
}

TEST(VolumeReceiver, StopsDecodingWhenTheJobStops) {
  const Volume torus = Torus();
  const std::string bytes = Encode(torus, VolumeEncoding::kOpenExr);
  VolumeReceiver receiver(Declare(torus, VolumeEncoding::kOpenExr), bytes.size(), VolumeLimits());
  ASSERT_TRUE(receiver.Append(bytes).ok());
  std::stop_source stop;
  stop.request_stop();
  exec::Context context;
  context.stop = stop.get_token();
  EXPECT_EQ(receiver.Finish(std::nullopt, context).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel::server
