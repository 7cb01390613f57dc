#include <gtest/gtest.h>

#include <string>

#include "core/io/volume_decoder.h"
#include "core/io/volume_digest.h"
#include "core/io/volume_encoder.h"
#include "tests/core/io/test_volumes.h"
#include "tests/support/contexts.h"
#include "tests/support/volume_headers.h"

namespace bccskel::volume_round_trip {
namespace {

struct Coding {
  VolumeEncoding encoding;
  VolumeCompression compression;
};

std::string NameOf(const testing::TestParamInfo<Coding>& info) {
  std::string name;
  for (auto part :
       {VolumeEncodingName(info.param.encoding), VolumeCompressionName(info.param.compression)}) {
    for (char c : part) {
      if (c != ' ') name.push_back(c);
    }
  }
  return name;
}

class VolumeRoundTrip : public testing::TestWithParam<Coding> {
 protected:
  // The bytes of a volume and the header that a receiver makes of them.
  struct Encoded {
    std::string bytes;
    VolumeHeader header;
  };

  Encoded Encode(const Volume& volume) {
    auto bytes = EncodeVolume(volume, {GetParam().encoding, GetParam().compression});
    EXPECT_TRUE(bytes.ok()) << bytes.status();
    auto header = HeaderOf(volume, *bytes);
    EXPECT_TRUE(header.ok()) << header.status();
    return {*std::move(bytes), *std::move(header)};
  }

  absl::StatusOr<VolumeHeader> HeaderOf(const Volume& volume, const std::string& bytes) {
    if (GetParam().encoding == VolumeEncoding::kRawPlanes) {
      return test::MakePlanesHeader(volume.extent(), volume.placement(), {},
                                    GetParam().compression);
    }
    return ScanVolumeHeader(GetParam().encoding, BytesOf(bytes), {});
  }

  absl::StatusOr<Volume> DecodeInPieces(const VolumeHeader& header, const std::string& bytes,
                                        size_t piece) {
    auto decoder = MakeVolumeDecoder(header, {});
    if (!decoder.ok()) return decoder.status();
    for (size_t at = 0; at < bytes.size(); at += piece) {
      const auto part = BytesOf(bytes).subspan(at, std::min(piece, bytes.size() - at));
      if (auto status = (*decoder)->Append(part); !status.ok()) return status;
    }
    return (*decoder)->Finish();
  }
};

TEST_P(VolumeRoundTrip, GivesTheSameVolumeBack) {
  for (const Volume& volume : EdgeVolumes()) {
    const auto [bytes, header] = Encode(volume);
    const auto back = DecodeInPieces(header, bytes, bytes.size() + 1);
    ASSERT_TRUE(back.ok()) << back.status();
    EXPECT_EQ(*back, volume) << volume.extent().nx << " x " << volume.extent().ny << " x "
                             << volume.extent().nz;
    EXPECT_EQ(VolumeDigest(*back), VolumeDigest(volume));
  }
}

TEST_P(VolumeRoundTrip, DoesNotDependOnHowTheBytesAreCut) {
  const Volume volume = RandomVolume({37, 11, 45}, 7);
  const auto [bytes, header] = Encode(volume);
  for (size_t piece : {1u, 3u, 79u, 160u, 161u, 4096u}) {
    const auto back = DecodeInPieces(header, bytes, piece);
    ASSERT_TRUE(back.ok()) << back.status();
    EXPECT_EQ(*back, volume) << "pieces of " << piece;
  }
}

TEST_P(VolumeRoundTrip, StaysWithinTheSizesThatTheHeaderPromises) {
  for (const Volume& volume : EdgeVolumes()) {
    const auto [bytes, header] = Encode(volume);
    EXPECT_LE(bytes.size(), header.max_encoded_bytes);
    EXPECT_LE(volume.brick_count(), header.max_bricks);
    EXPECT_EQ(header.extent, volume.extent());
    EXPECT_EQ(header.placement, volume.placement());
    EXPECT_EQ(header.compression, GetParam().compression);
  }
}

TEST_P(VolumeRoundTrip, RefusesBytesThatEndEarlyOrLate) {
  const Volume volume = RandomVolume({20, 6, 40}, 3);
  const auto [bytes, header] = Encode(volume);
  const auto early = DecodeInPieces(header, bytes.substr(0, bytes.size() - 1), 100);
  EXPECT_EQ(early.status().code(), absl::StatusCode::kInvalidArgument) << early.status();
  const auto late = DecodeInPieces(header, bytes + '\0', 100);
  EXPECT_EQ(late.status().code(), absl::StatusCode::kInvalidArgument) << late.status();
}

TEST_P(VolumeRoundTrip, StopsWhenTheContextSaysSo) {
  const Volume volume = RandomVolume({20, 6, 40}, 3);
  const exec::Context stopped = test::Stopped();
  const auto [bytes, header] = Encode(volume);
  auto decoder = MakeVolumeDecoder(header, {});
  ASSERT_TRUE(decoder.ok()) << decoder.status();
  ASSERT_TRUE((*decoder)->Append(BytesOf(bytes)).ok());
  EXPECT_EQ((*decoder)->Finish(stopped).status().code(), absl::StatusCode::kCancelled);
}

TEST_P(VolumeRoundTrip, RefusesMoreBricksThanTheLimit) {
  const Volume volume = FullVolume({40, 10, 20});
  auto [bytes, header] = Encode(volume);
  const VolumeLimits limits = {.max_bricks = volume.brick_count() - 1};
  header.declared_bricks.reset();  // what a sender that declares nothing gets
  auto decoder = MakeVolumeDecoder(header, limits);
  if (GetParam().encoding == VolumeEncoding::kRawPlanes) {
    ASSERT_TRUE(decoder.ok()) << decoder.status();
    EXPECT_EQ((*decoder)->Append(BytesOf(bytes)).code(), absl::StatusCode::kResourceExhausted);
  } else {
    EXPECT_EQ(DecodeVolume(GetParam().encoding, bytes, limits).status().code(),
              absl::StatusCode::kResourceExhausted);
  }
}

INSTANTIATE_TEST_SUITE_P(
    AllCodings, VolumeRoundTrip,
    testing::Values(Coding{VolumeEncoding::kOpenExr, VolumeCompression::kNone},
                    Coding{VolumeEncoding::kOpenExr, VolumeCompression::kRle},
                    Coding{VolumeEncoding::kOpenExr, VolumeCompression::kZips},
                    Coding{VolumeEncoding::kOpenExr, VolumeCompression::kZip},
                    Coding{VolumeEncoding::kRawPlanes, VolumeCompression::kNone},
                    Coding{VolumeEncoding::kRawPlanes, VolumeCompression::kZstd},
                    Coding{VolumeEncoding::kBricks, VolumeCompression::kNone},
                    Coding{VolumeEncoding::kBricks, VolumeCompression::kZstd}),
    NameOf);

}  // namespace
}  // namespace bccskel::volume_round_trip
