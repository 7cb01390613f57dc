#ifndef BCCSKEL_TESTS_CORE_IMPORT_IMAGE_DICOM_FILES_H_
#define BCCSKEL_TESTS_CORE_IMPORT_IMAGE_DICOM_FILES_H_

#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/lattice/lattice_point.h"

// DICOM, element by element.
namespace bccskel::testing::dicom {

inline constexpr int kX = 3, kY = 2;

inline void Put(DcmItem& data, const DcmTagKey& tag, const std::string& value) {
  ASSERT_TRUE(data.putAndInsertString(tag, value.c_str()).good()) << value;
}

inline void PutShort(DcmItem& data, const DcmTagKey& tag, uint16_t value) {
  ASSERT_TRUE(data.putAndInsertUint16(tag, value).good());
}

inline void PutItems(DcmItem& data, const DcmTagKey& tag, const std::vector<DcmItem>& items) {
  data.findAndDeleteElement(tag);
  for (const DcmItem& item : items) {
    DcmItem* added = nullptr;
    ASSERT_TRUE(data.findOrCreateSequenceItem(tag, added, -2).good());
    *added = item;
  }
}

inline void PutWords(DcmItem& data, const std::vector<uint16_t>& words) {
  ASSERT_TRUE(data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size()).good());
}

inline std::string Position(const WorldPoint& p) {
  return absl::StrFormat("%g\\%g\\%g", p[0], p[1], p[2]);
}

// A plane of kX * kY unsigned values of 16 bits.
inline DcmDataset Slice(const WorldPoint& position, int first_value) {
  DcmDataset data;
  Put(data, DCM_SOPClassUID, UID_CTImageStorage);
  Put(data, DCM_SOPInstanceUID, absl::StrFormat("1.2.3.%d", first_value + 1));
  Put(data, DCM_Modality, "CT");
  Put(data, DCM_SeriesDescription, "Thorax");
  Put(data, DCM_SeriesInstanceUID, "1.2.3.4");
  Put(data, DCM_SeriesNumber, "3");
  Put(data, DCM_ImagePositionPatient, Position(position));
  Put(data, DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0");
  PutShort(data, DCM_SamplesPerPixel, 1);
  Put(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  PutShort(data, DCM_Rows, kY);
  PutShort(data, DCM_Columns, kX);
  Put(data, DCM_PixelSpacing, "0.5\\0.25");
  PutShort(data, DCM_BitsAllocated, 16);
  PutShort(data, DCM_BitsStored, 16);
  PutShort(data, DCM_HighBit, 15);
  PutShort(data, DCM_PixelRepresentation, 0);
  std::vector<uint16_t> words;
  for (int n = 0; n < kX * kY; ++n) words.push_back(static_cast<uint16_t>(first_value + n));
  PutWords(data, words);
  return data;
}

inline void Write(const std::string& path, DcmDataset data,
                  E_TransferSyntax syntax = EXS_LittleEndianExplicit) {
  if (syntax != EXS_LittleEndianExplicit) {
    ASSERT_TRUE(data.chooseRepresentation(syntax, nullptr).good());
  }
  DcmFileFormat file(&data);
  const OFCondition saved = file.saveFile(path.c_str(), syntax);
  ASSERT_TRUE(saved.good()) << path << ": " << saved.text();
}

inline DcmItem WithItem(const DcmTagKey& group, const DcmTagKey& tag, const std::string& value) {
  DcmItem nested, data;
  Put(nested, tag, value);
  PutItems(data, group, {nested});
  return data;
}

}  // namespace bccskel::testing::dicom

#endif  // BCCSKEL_TESTS_CORE_IMPORT_IMAGE_DICOM_FILES_H_
