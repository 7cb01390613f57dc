// Pins the bytes of the formats: files that were written once must be read for ever, and what does
// not depend on a compressor's version must be written the same for ever.
// Made anew, when a format gets a new version, by running this test with BCCSKEL_BLESS=1 set.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "core/io/volume_decoder.h"
#include "core/io/volume_digest.h"
#include "core/io/volume_encoder.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/volume_headers.h"
#include "tests/support/volume_where.h"

namespace bccskel::volume_golden {
namespace {

constexpr LatticeExtent kExtent = {19, 6, 37};
const Placement kPlacement = {.spacing = {0.5, 0.25, 2},
                              .origin = {-1.5, 0, 1e-3},
                              .direction = {0, 1, 0, -1, 0, 0, 0, 0, 1}};

// An ellipsoid that touches the walls, and two opposite corners.
Volume GoldenVolume() {
  const auto is_in = [](int32_t x, int32_t y, int32_t z) {
    const int32_t dx = 2 * (x - 19), dy = 6 * (y - 6), dz = z - 37;
    const LatticePoint p = {x, y, z};
    return dx * dx + dy * dy + dz * dz <= 37 * 37 || p == LatticePoint{0, 0, 0} ||
           p == LatticePoint{37, 11, 73};
  };
  return test::VolumeWhere(kExtent, is_in, kPlacement);
}

struct Golden {
  std::string name;
  VolumeEncoding encoding;
  VolumeCompression compression;
  enum class Bytes { kPinned, kFreeToChange } bytes;
};

class VolumeGolden : public testing::TestWithParam<Golden> {
 protected:
  std::string Path() const { return std::string(BCCSKEL_GOLDEN_DIR) + "/" + GetParam().name; }

  std::string Encoded() const {
    return *EncodeVolume(GoldenVolume(), {GetParam().encoding, GetParam().compression});
  }
  std::string FromFile() const {
    if (std::getenv("BCCSKEL_BLESS") != nullptr) {
      std::ofstream(Path(), std::ios::binary) << Encoded();
    }
    return test::BytesOfFile(Path());
  }
};

TEST_P(VolumeGolden, IsReadAsTheSameVolume) {
  const std::string bytes = FromFile();
  const auto header =
      GetParam().encoding == VolumeEncoding::kRawPlanes
          ? test::MakePlanesHeader(kExtent, kPlacement, {})
          : ScanVolumeHeader(GetParam().encoding, std::as_bytes(std::span(bytes)), {});
  ASSERT_TRUE(header.ok()) << header.status();
  const auto decoder = MakeVolumeDecoder(*header, {});
  ASSERT_TRUE(decoder.ok()) << decoder.status();
  ASSERT_TRUE((*decoder)->Append(std::as_bytes(std::span(bytes))).ok());
  const auto volume = (*decoder)->Finish();
  ASSERT_TRUE(volume.ok()) << volume.status();
  EXPECT_EQ(*volume, GoldenVolume());
}

TEST_P(VolumeGolden, IsWrittenWithTheSameBytes) {
  if (GetParam().bytes == Golden::Bytes::kFreeToChange) {
    GTEST_SKIP() << "the compressed bytes may differ with the version of the compressor";
  }
  EXPECT_TRUE(Encoded() == FromFile()) << Path();
}

INSTANTIATE_TEST_SUITE_P(
    Files, VolumeGolden,
    testing::Values(Golden{"volume_none.exr", VolumeEncoding::kOpenExr, VolumeCompression::kNone,
                           Golden::Bytes::kPinned},
                    Golden{"volume_rle.exr", VolumeEncoding::kOpenExr, VolumeCompression::kRle,
                           Golden::Bytes::kPinned},
                    Golden{"volume_zip.exr", VolumeEncoding::kOpenExr, VolumeCompression::kZip,
                           Golden::Bytes::kFreeToChange},
                    Golden{"volume.planes", VolumeEncoding::kRawPlanes, VolumeCompression::kNone,
                           Golden::Bytes::kPinned},
                    Golden{"volume.bccb", VolumeEncoding::kBricks, VolumeCompression::kNone,
                           Golden::Bytes::kPinned},
                    Golden{"volume_zstd.bccb", VolumeEncoding::kBricks, VolumeCompression::kZstd,
                           Golden::Bytes::kFreeToChange}));

TEST(VolumeDigestGolden, NeverChanges) {
  EXPECT_EQ(VolumeDigest(GoldenVolume()),
            "efb2bd591175b133a2865a85ce20e9992f8b40cd8d156a16c33bee9820a20da1");
}

}  // namespace
}  // namespace bccskel::volume_golden
