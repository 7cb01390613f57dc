// What a build without BCCSKEL_DICOM says of DICOM.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/core/import/image/image_folder.h"

namespace bccskel {
namespace {

TEST(DicomAbsent, TheOptionOfTheBuildIsNamed) {
  const testing::ImageFolder folder("no_dicom");
  folder.Write("IM0001", std::string(128, '\0') + "DICM and what follows");
  for (const std::string& path : {folder.path(), folder.path() + "/IM0001"}) {
    const absl::Status status = OpenImage(path).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kUnimplemented);
    EXPECT_THAT(status.message(), ::testing::HasSubstr("configure with -DBCCSKEL_DICOM=ON"));
  }
  ImageOptions options;
  options.series = "3";
  folder.Write(".zarray", "{}");
  EXPECT_THAT(OpenImage(folder.path(), options).status().message(),
              ::testing::HasSubstr("--series applies only to folders of DICOM files"));
}

}  // namespace
}  // namespace bccskel
