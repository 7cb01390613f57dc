// The whole path on volumes of others whose topology is known: see MANIFEST.md beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/import/image/foreground.h"
#include "core/import/image/open_image.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"
#include "tests/support/contexts.h"

namespace bccskel {

void PrintTo(const BettiNumbers& b, std::ostream* out) {
  *out << "(" << b.components << ", " << b.loops << ", " << b.cavities << ")";
}

namespace {

struct RealVolume {
  const char* file;
  ForegroundRule rule;
  uint64_t voxels;
  BettiNumbers topology;  // (26, 6)
};

void PrintTo(const RealVolume& volume, std::ostream* out) { *out << volume.file; }

const std::vector<RealVolume>& KnownVolumes() {
  static const ForegroundRule kSet = ForegroundRule::NonZero();
  static const std::vector<RealVolume> kVolumes = {
      {"airway_p4_chopped.nrrd", kSet, 485117, {1, 2, 0}},
      {"neuron_28648864.nrrd", kSet, 335259, {1, 1, 1}},
      {"neuron_28018323.nrrd", kSet, 384708, {4, 4, 0}},
      {"neuron_28794499.nrrd", kSet, 1446575, {3, 6, 5}},
      {"Al.100.vol", kSet, 70413, {1, 2, 0}},
      {"cat10b.vol", kSet, 8043, {1, 0, 0}},
      {"lobster.vol", *ForegroundRule::From(40), 269432, {46, 547, 222}},
      {"lobsterCroped2.nii.gz", *ForegroundRule::From(40), 50899, {3, 102, 50}},
      {"liver.inr.gz", *ForegroundRule::Labels({127}), 314086, {1, 0, 33}},
      {"poon2015_BBB_noLeakage_manualLabel_v2.tif", kSet, 242943, {153, 224, 0}},
      {"santos2015_lowContrastVessels_labelsMarc.tif", kSet, 458204, {11, 32, 0}},
      {"100_fiberform.tif", *ForegroundRule::From(90), 167140, {10, 6, 16}},
      {"aorta-final-levelset.mha", *ForegroundRule::Below(0), 11590, {1, 0, 0}},
  };
  return kVolumes;
}

ConvertedMask ConvertedVolume(const RealVolume& volume) {
  const auto image = OpenImage(std::string(BCCSKEL_TEST_DATA_DIR "/volume/") + volume.file);
  EXPECT_TRUE(image.ok()) << image.status();
  const ImageInfo& info = (*image)->info();
  const MaskGrid grid = {info.size.nx, info.size.ny, info.size.nz, info.placement};
  auto converter = MaskConverter::Create(grid, {});
  std::vector<uint64_t> words(grid.WordsPerSlice());
  for (int32_t z = 0; z < grid.nz; ++z) {
    const auto slice = (*image)->NextSlice();
    EXPECT_TRUE(slice.ok()) << slice.status();
    ForegroundSlice(*slice, volume.rule, words);
    EXPECT_TRUE(converter->AddSlice(words, {}).ok());
  }
  auto converted = std::move(*converter).Finish();
  EXPECT_TRUE(converted.ok()) << converted.status();
  return *std::move(converted);
}

class RealVolumes : public ::testing::TestWithParam<RealVolume> {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(BCCSKEL_TEST_DATA_DIR "/volume")) {
      GTEST_SKIP() << "no reference volumes in " BCCSKEL_TEST_DATA_DIR
                      ": set the CMake variable BCCSKEL_TEST_DATA";
    }
  }
};

TEST_P(RealVolumes, KeepTheirTopologyThroughMaskObjectAndSkeleton) {
  const ConvertedMask converted = ConvertedVolume(GetParam());
  EXPECT_EQ(converted.voxels, GetParam().voxels);
  EXPECT_EQ(converted.mask, GetParam().topology);
  test::TeamContext context(std::max(static_cast<int>(std::thread::hardware_concurrency()), 1));
  const auto skeleton = Skeletonize(converted.volume, {}, context);
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  EXPECT_EQ(skeleton->certificate.input, GetParam().topology);
  EXPECT_EQ(skeleton->certificate.skeleton, GetParam().topology);
  EXPECT_EQ(skeleton->certificate.simple_points_left, 0u);
}

std::string NameOf(const ::testing::TestParamInfo<RealVolume>& info) {
  std::string name = info.param.file;
  std::erase_if(name, [](char c) { return c == '-' || c == '_' || c == '.'; });
  return name;
}

INSTANTIATE_TEST_SUITE_P(Manifest, RealVolumes, ::testing::ValuesIn(KnownVolumes()), NameOf);

}  // namespace
}  // namespace bccskel
