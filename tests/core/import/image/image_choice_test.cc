#include <gtest/gtest.h>

#include <string>

#include "core/import/image/open_image.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

TEST(CheckImageChoice, KnowsTheFormatByItsEndingOrItsFirstBytes) {
  ImageOptions page, level, series;
  page.channel = 0;
  level.level = 0;
  series.series = "1";
  for (const char* path : {"a.tif", "b.TIFF.gz", "c.dcm", "no-image"}) {
    EXPECT_TRUE(CheckImageChoice(path, page).ok()) << path;
  }
  EXPECT_FALSE(CheckImageChoice("a.nii", page).ok());
  EXPECT_FALSE(CheckImageChoice("a.tif", level).ok());
  EXPECT_FALSE(CheckImageChoice("a.tif", series).ok());
  EXPECT_TRUE(CheckImageChoice("a.dcm", series).ok());
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("tiff.img", std::string("II*\0\x08\0\0\0", 8));
  EXPECT_TRUE(CheckImageChoice(path, page).ok());
  page.raw.emplace();
  EXPECT_FALSE(CheckImageChoice(path, page).ok());
}

TEST(IsImagePath, KnowsEndingsWhateverTheirCase) {
  for (const char* name : {"a.nii", "b/c.NII.GZ", "x.nrrd", "x.nrrd.gz", "x.tif", "x.tif.gz",
                           "x.mha", "x.mha.gz", "x.inr.gz", "x.npy", "x.npz", "x.npy.gz", "x.PNG",
                           "x.vol", "x.vol.gz", "x.hdr", "x.img", "x.img.gz"}) {
    EXPECT_TRUE(IsImagePath(name)) << name;
  }
  for (const char* name : {"a.off", "nii", "x.exr", "x.gz", "x.zip", "png"}) {
    EXPECT_FALSE(IsImagePath(name)) << name;
  }
}

}  // namespace
}  // namespace bccskel
