// DICOM files written here with DCMTK: what is read, chosen and refused.
#include <dcmtk/dcmdata/dcrleerg.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "tests/core/import/image/dicom_files.h"
#include "tests/core/import/image/image_folder.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

using ::testing::AllOf;
using testing::CountedTo;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::ImageFolder;
using ::testing::Pointwise;
using testing::dicom::kX;
using testing::dicom::kY;
using testing::dicom::Position;
using testing::dicom::Put;
using testing::dicom::PutItems;
using testing::dicom::PutShort;
using testing::dicom::PutWords;
using testing::dicom::Slice;
using testing::dicom::WithItem;
using testing::dicom::Write;

using Change = std::function<void(int z, DcmDataset& slice)>;

// Slices at z * 2 mm, the last one in the first file.
void WriteSeries(const ImageFolder& folder, int slices, const Change& change = nullptr,
                 const std::string& prefix = "") {
  for (int z = 0; z < slices; ++z) {
    DcmDataset slice = Slice({7, 8, 9 + 2.0 * z}, 6 * z);
    if (change) change(z, slice);
    Write(absl::StrFormat("%s/%s%02d", folder.path(), prefix, slices - z), slice);
  }
}

TEST(Dicom, SlicesAreSortedByTheirPositions) {
  const ImageFolder folder("dicom");
  WriteSeries(folder, 4);
  folder.Write("notes.txt", "no DICOM");
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.info.size, (ImageSize{kX, kY, 4}));
  EXPECT_EQ(image.info.type, VoxelType::kUint16);
  EXPECT_EQ(image.info.world, "LPS");
  EXPECT_EQ(image.info.unit, "mm");
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(0.25, 0.5, 2));
  EXPECT_THAT(image.info.placement.origin, ElementsAre(7, 8, 9));
  EXPECT_EQ(image.values, CountedTo(4 * kX * kY));
}

TEST(Dicom, TheOrientationIsFoldedIn) {
  const ImageFolder folder("dicom");
  // Rows go to -y, columns to -z, so slices to +x.
  WriteSeries(folder, 3, [](int z, DcmDataset& slice) {
    Put(slice, DCM_ImageOrientationPatient, "0\\-1\\0\\0\\0\\-1");
    Put(slice, DCM_ImagePositionPatient, Position({3.0 * z, 50, 60}));
  });
  const auto image = MustRead(folder.Read());
  const Placement& placement = image.info.placement;
  EXPECT_THAT(placement.spacing, ElementsAre(0.25, 0.5, 3));
  const WorldPoint corner = placement.ToWorld(2 * 2, 2 * 1, 2 * 2);
  EXPECT_THAT(corner, Pointwise(DoubleNear(1e-9), {6.0, 50 - 0.5, 60 - 0.5}));
}

TEST(Dicom, RescaledValuesAreDoubles) {
  const ImageFolder folder("dicom");
  WriteSeries(folder, 2, [](int z, DcmDataset& slice) {
    Put(slice, DCM_RescaleIntercept, "-1000");
    Put(slice, DCM_RescaleSlope, z == 0 ? "2" : "0.5");
  });
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.info.type, VoxelType::kFloat64);
  EXPECT_EQ(image.values[1], -998);
  EXPECT_EQ(image.values[6], -997);
}

TEST(Dicom, CompressedSlicesAreExpanded) {
  DcmRLEEncoderRegistration::registerCodecs();
  const ImageFolder folder("dicom");
  for (int z = 0; z < 3; ++z) {
    Write(absl::StrFormat("%s/%d.dcm", folder.path(), z), Slice({0, 0, 1.0 * z}, 6 * z),
          EXS_RLELossless);
  }
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.values, CountedTo(3 * kX * kY));
}

TEST(Dicom, OneOfSeveralSeriesIsChosen) {
  const ImageFolder folder("dicom");
  WriteSeries(folder, 3);
  WriteSeries(
      folder, 2,
      [](int, DcmDataset& slice) {
        Put(slice, DCM_SeriesInstanceUID, "1.2.3.5");
        Put(slice, DCM_SeriesNumber, "8");
        Put(slice, DCM_SeriesDescription, "Localizer");
      },
      "b");
  EXPECT_THAT(ErrorOf(folder),
              AllOf(HasSubstr("2 series: 3 'Thorax' (3 files, 1.2.3.4), 8 'Localizer' (2 files, "
                              "1.2.3.5)"),
                    HasSubstr("--series")));
  ImageOptions options;
  for (const auto& [choice, slices] : {std::pair{"3", 3}, {"8", 2}, {"1.2.3.5", 2}}) {
    options.series = choice;
    const auto image = MustRead(folder.Read(options));
    EXPECT_EQ(image.info.size.nz, slices);
  }
  options.series = "9";
  EXPECT_THAT(ErrorOf(folder, options), HasSubstr("'9' is no series of the folder: 3 'Thorax'"));
}

TEST(Dicom, WhatIsNoStackOfSlicesIsRefused) {
  struct Case {
    const char* message;
    Change change;
  };
  const auto at = [](DcmDataset& slice, const WorldPoint& p) {
    Put(slice, DCM_ImagePositionPatient, Position(p));
  };
  const std::vector<Case> cases = {
      {"2 slices are missing between '03' and '02'",
       [&](int z, DcmDataset& slice) {
         at(slice, {7, 8, z < 4 ? 2.0 * z : 2.0 * z + 4});
       }},
      {"two slices lie at one position, '03' and '04'",
       [&](int z, DcmDataset& slice) {
         at(slice, {7, 8, z < 3 ? 2.0 * z : 2.0 * z - 2});
       }},
      {"spaced unevenly: 2.7 mm",
       [&](int z, DcmDataset& slice) {
         at(slice, {7, 8, z < 3 ? 2.0 * z : 2.0 * z + 0.7});
       }},
      {"each slice is moved by 0.5 mm against the one before, as by a gantry tilted by 14.0 "
       "degrees",
       [&](int z, DcmDataset& slice) {
         at(slice, {7, 0.5 * z, 2.0 * z});
       }},
      {"'04' lies beside the line",
       [&](int z, DcmDataset& slice) {
         at(slice, {z == 2 ? 9.0 : 7.0, 8, 2.0 * z});
       }},
      {"differ in their pixel spacing",
       [](int z, DcmDataset& slice) {
         if (z == 2) Put(slice, DCM_PixelSpacing, "0.5\\0.3");
       }},
      {"differ in their orientation",
       [](int z, DcmDataset& slice) {
         if (z == 2) Put(slice, DCM_ImageOrientationPatient, "0\\1\\0\\1\\0\\0");
       }},
      {"differ in their size",
       [](int z, DcmDataset& slice) {
         if (z == 2) PutShort(slice, DCM_Rows, 5);
       }},
      {"no ImagePositionPatient",
       [](int z, DcmDataset& slice) {
         if (z == 2) Put(slice, DCM_ImagePositionPatient, "");
       }},
      {"ImagePositionPatient 'nan\\\\0\\\\1'",
       [](int z, DcmDataset& slice) {
         if (z == 2) Put(slice, DCM_ImagePositionPatient, "nan\\0\\1");
       }},
      {"PixelSpacing '2' has not 2 numbers",
       [](int z, DcmDataset& slice) {
         if (z == 2) Put(slice, DCM_PixelSpacing, "2");
       }},
      {"unit vectors",
       [](int z, DcmDataset& slice) {
         if (z == 2) Put(slice, DCM_ImageOrientationPatient, "0\\2\\0\\1\\0\\0");
       }},
      {"3 samples a pixel",
       [](int, DcmDataset& slice) { PutShort(slice, DCM_SamplesPerPixel, 3); }},
  };
  for (const auto& [message, change] : cases) {
    const ImageFolder folder("dicom");
    WriteSeries(folder, 6, change);
    EXPECT_THAT(ErrorOf(folder), HasSubstr(message));
  }
}

// Frames with facts of their own, at the heights.
DcmDataset Frames(const std::vector<double>& heights) {
  DcmDataset data = Slice({0, 0, 0}, 0);
  for (const DcmTagKey& tag :
       {DCM_ImagePositionPatient, DCM_ImageOrientationPatient, DCM_PixelSpacing}) {
    data.findAndDeleteElement(tag);
  }
  Put(data, DCM_NumberOfFrames, std::to_string(heights.size()));
  DcmItem shared =
      WithItem(DCM_PlaneOrientationSequence, DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0");
  DcmItem measures;
  Put(measures, DCM_PixelSpacing, "1\\1");
  Put(measures, DCM_SpacingBetweenSlices, "2");
  PutItems(shared, DCM_PixelMeasuresSequence, {measures});
  PutItems(data, DCM_SharedFunctionalGroupsSequence, {shared});
  std::vector<DcmItem> own;
  for (const double height : heights) {
    own.push_back(
        WithItem(DCM_PlanePositionSequence, DCM_ImagePositionPatient, Position({0, 0, height})));
  }
  PutItems(data, DCM_PerFrameFunctionalGroupsSequence, own);
  return data;
}

TEST(Dicom, AFileHoldsSeveralFrames) {
  const ImageFolder folder("dicom");
  std::vector<uint16_t> words;
  for (uint16_t n = 0; n < 3 * kX * kY; ++n) words.push_back(n);
  DcmDataset data = Frames({4, 0, 2});
  Put(data, DCM_SOPClassUID, UID_EnhancedCTImageStorage);
  PutWords(data, words);
  Write(folder.path() + "/a.dcm", data);
  const auto image = MustRead(testing::ReadAll(OpenImage(folder.path() + "/a.dcm")));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 1, 2));
  EXPECT_EQ(image.values[0], 6);   // the second frame is the lowest
  EXPECT_EQ(image.values[6], 12);  // then the third
  EXPECT_EQ(image.values[12], 0);
}

struct SegmentFrame {
  double height;
  uint16_t segment;
  std::string bits;  // of kX * kY voxels
};

void WriteSegmentation(const ImageFolder& folder, const std::vector<SegmentFrame>& frames,
                       const std::string& type = "BINARY") {
  std::vector<double> heights;
  std::string bits;
  for (const SegmentFrame& frame : frames) {
    heights.push_back(frame.height);
    bits += frame.bits;
  }
  std::vector<uint8_t> bytes((bits.size() + 15) / 16 * 2);
  for (size_t n = 0; n < bits.size(); ++n) {
    if (bits[n] == '1') bytes[n / 8] = static_cast<uint8_t>(bytes[n / 8] | 1 << n % 8);
  }
  DcmDataset data = Frames(heights);
  Put(data, DCM_SOPClassUID, UID_SegmentationStorage);
  Put(data, DCM_SegmentationType, type);
  PutShort(data, DCM_BitsAllocated, 1);
  PutShort(data, DCM_BitsStored, 1);
  PutShort(data, DCM_HighBit, 0);
  std::vector<DcmItem> own;
  for (const SegmentFrame& frame : frames) {
    DcmItem item = WithItem(DCM_PlanePositionSequence, DCM_ImagePositionPatient,
                            Position({0, 0, frame.height}));
    DcmItem segment;
    PutShort(segment, DCM_ReferencedSegmentNumber, frame.segment);
    PutItems(item, DCM_SegmentIdentificationSequence, {segment});
    own.push_back(item);
  }
  PutItems(data, DCM_PerFrameFunctionalGroupsSequence, own);
  data.findAndDeleteElement(DCM_PixelData);
  ASSERT_TRUE(data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), bytes.size()).good());
  Write(folder.path() + "/seg.dcm", data);
}

TEST(Dicom, NumbersOfSegmentsAreLabels) {
  const ImageFolder folder("dicom");
  // Heights 0, 2 (empty) and 4 mm.
  WriteSegmentation(folder, {{4, 5, "000011"}, {0, 1, "110000"}, {4, 300, "100000"}});
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.info.format, "DICOM segmentation");
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 1, 2));
  EXPECT_THAT(image.values, ElementsAre(1, 1, 0, 0, 0, 0,  //
                                        0, 0, 0, 0, 0, 0,  //
                                        300, 0, 0, 0, 5, 5));
}

TEST(Dicom, SegmentsThatOverlapAreChosen) {
  const ImageFolder folder("dicom");
  WriteSegmentation(folder, {{0, 1, "110000"}, {0, 2, "011000"}});
  EXPECT_THAT(ErrorOf(folder), HasSubstr("segments 1 and 2 overlap; choose one with --channel"));
  ImageOptions options;
  options.channel = 2;
  const auto image = MustRead(folder.Read(options));
  EXPECT_THAT(image.values, ElementsAre(0, 2, 2, 0, 0, 0));
  options.channel = 3;
  EXPECT_THAT(ErrorOf(folder, options), HasSubstr("no segment 3"));
  WriteSegmentation(folder, {{0, 1, "110000"}}, "FRACTIONAL");
  EXPECT_THAT(ErrorOf(folder), HasSubstr("'FRACTIONAL' is not supported"));
}

TEST(Dicom, DamagedFilesAreRefused) {
  const ImageFolder folder("dicom");
  const auto bytes_of = [&](const std::string& name) {
    return test::BytesOfFile(folder.path() + "/" + name);
  };
  WriteSeries(folder, 1);
  const std::string slice = bytes_of("01");
  for (size_t length = 132; length < slice.size(); ++length) {
    folder.Write("01", slice.substr(0, length));
    EXPECT_FALSE(folder.Read().ok()) << length << " of " << slice.size();
  }
  for (size_t at = 132; at < slice.size(); ++at) {  // whatever comes of it
    std::string flipped = slice;
    flipped[at] = static_cast<char>(~flipped[at]);
    folder.Write("01", flipped);
    (void)folder.Read();
  }
  std::filesystem::remove(folder.path() + "/01");
  WriteSegmentation(folder, {{0, 1, "110000"}, {2, 2, "011000"}});
  const std::string segments = bytes_of("seg.dcm");
  for (size_t length = 132; length < segments.size(); length += 3) {
    folder.Write("seg.dcm", segments.substr(0, length));
    EXPECT_FALSE(folder.Read().ok()) << length << " of " << segments.size();
  }
}

TEST(Dicom, OptionsOfOtherFormatsAreRefused) {
  const ImageFolder folder("dicom");
  WriteSeries(folder, 2);
  ImageOptions options;
  options.channel = 1;
  EXPECT_THAT(ErrorOf(folder, options), HasSubstr("--channel applies only to segmentations"));
  options = {};
  options.level = 1;
  EXPECT_THAT(ErrorOf(folder, options), HasSubstr("--level"));
  options = {};
  options.spacing = {3, 4, 5};
  EXPECT_THAT(folder.Read(options)->info.placement.spacing, ElementsAre(3, 4, 5));
}

}  // namespace
}  // namespace bccskel
