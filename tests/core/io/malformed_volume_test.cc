// Bytes that were damaged on the way: every outcome is a volume or an error, never a crash, and the
// memory stays small.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <random>
#include <string>

#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "tests/core/io/test_volumes.h"

namespace bccskel {
namespace {

struct Coding {
  VolumeEncoding encoding;
  VolumeCompression compression;
};

constexpr VolumeLimits kLimits = {.max_bricks = 1000, .max_decoded_bytes = 1 << 20};

// What decoding damaged volumes of a few hundred bytes may add to the peak.
#if defined(__SANITIZE_ADDRESS__)
constexpr long kMoreKiB = 512 * 1024;  // freed memory is kept in quarantine
#else
constexpr long kMoreKiB = 64 * 1024;
#endif

class MalformedVolume : public testing::TestWithParam<Coding> {
 protected:
  static long PeakKiB() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  }

  std::string Encode(const Volume& volume) const {
    return *EncodeVolume(volume, {GetParam().encoding, GetParam().compression});
  }
  absl::StatusOr<Volume> Decode(std::string_view bytes) const {
    return DecodeVolume(GetParam().encoding, bytes, kLimits);
  }
  static bool IsExpected(const absl::Status& status) {
    return status.ok() || status.code() == absl::StatusCode::kInvalidArgument ||
           status.code() == absl::StatusCode::kResourceExhausted;
  }
};

TEST_P(MalformedVolume, CutAtEveryByteIsAnError) {
  const std::string bytes = Encode(RandomVolume({9, 5, 34}, 2));
  for (size_t length = 0; length < bytes.size(); ++length) {
    const auto volume = Decode(std::string_view(bytes).substr(0, length));
    ASSERT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument) << length << " bytes";
  }
}

TEST_P(MalformedVolume, BitFlipsGiveAnErrorOrAVolume) {
  const std::string bytes = Encode(RandomVolume({30, 9, 40}, 4));
  std::mt19937_64 random(99);
  const long before = PeakKiB();
  for (int round = 0; round < 4000; ++round) {
    std::string damaged = bytes;
    const uint64_t flips = 1 + random() % 4;
    for (uint64_t n = 0; n < flips; ++n) {
      const size_t at = random() % damaged.size();
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    }
    const auto volume = Decode(damaged);
    ASSERT_TRUE(IsExpected(volume.status())) << "round " << round << ": " << volume.status();
    EXPECT_TRUE(!volume.ok() || CheckGrid(volume->extent(), volume->placement()).ok());
  }
  EXPECT_LT(PeakKiB() - before, kMoreKiB);
}

// The header is where a lie costs most: every byte of it takes every extreme value.
TEST_P(MalformedVolume, ExtremeBytesInTheHeaderGiveAnErrorOrAVolume) {
  const std::string bytes = Encode(RandomVolume({9, 5, 34}, 2));
  const long before = PeakKiB();
  for (size_t at = 0; at < std::min<size_t>(bytes.size(), 2000); ++at) {
    for (int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(value);
      const auto volume = Decode(damaged);
      ASSERT_TRUE(IsExpected(volume.status())) << "byte " << at << ": " << volume.status();
    }
  }
  EXPECT_LT(PeakKiB() - before, kMoreKiB);
}

TEST_P(MalformedVolume, NoiseAfterTheHeaderGivesAnErrorOrAVolume) {
  const std::string bytes = Encode(RandomVolume({30, 9, 40}, 4));
  std::mt19937_64 random(7);
  for (int round = 0; round < 300; ++round) {
    std::string damaged = bytes;
    const size_t begin = damaged.size() / 2 + random() % (damaged.size() / 2);
    for (size_t at = begin; at < std::min(damaged.size(), begin + 64); ++at) {
      damaged[at] = static_cast<char>(random());
    }
    const auto volume = Decode(damaged);
    ASSERT_TRUE(IsExpected(volume.status())) << "round " << round << ": " << volume.status();
  }
}

INSTANTIATE_TEST_SUITE_P(AllCodings, MalformedVolume,
                         testing::Values(Coding{VolumeEncoding::kOpenExr, VolumeCompression::kNone},
                                         Coding{VolumeEncoding::kOpenExr, VolumeCompression::kRle},
                                         Coding{VolumeEncoding::kOpenExr, VolumeCompression::kZips},
                                         Coding{VolumeEncoding::kOpenExr, VolumeCompression::kZip},
                                         Coding{VolumeEncoding::kBricks, VolumeCompression::kNone},
                                         Coding{VolumeEncoding::kBricks,
                                                VolumeCompression::kZstd}));

}  // namespace
}  // namespace bccskel
