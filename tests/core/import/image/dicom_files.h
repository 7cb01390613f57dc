#ifndef BCCSKEL_TESTS_CORE_IMPORT_IMAGE_DICOM_FILES_H_
#define BCCSKEL_TESTS_CORE_IMPORT_IMAGE_DICOM_FILES_H_

#include <gdcmSequenceOfItems.h>
#include <gdcmWriter.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/lattice/lattice_point.h"

// DICOM, element by element.
namespace bccskel::testing::dicom {

using gdcm::DataSet;
using gdcm::Tag;
using gdcm::VR;

inline constexpr int kX = 3, kY = 2;

inline void Put(DataSet& data, const Tag& tag, VR::VRType vr, std::string value) {
  if (value.size() % 2 == 1) value += vr == VR::UI || vr == VR::OB ? '\0' : ' ';
  gdcm::DataElement element(tag);
  element.SetVR(vr);
  element.SetByteValue(value.data(), gdcm::VL(static_cast<uint32_t>(value.size())));
  data.Replace(element);
}

inline void PutShort(DataSet& data, const Tag& tag, uint16_t value) {
  Put(data, tag, VR::US, {static_cast<char>(value & 255), static_cast<char>(value >> 8)});
}

inline void PutItems(DataSet& data, const Tag& tag, const std::vector<DataSet>& items) {
  gdcm::SmartPointer<gdcm::SequenceOfItems> sequence = new gdcm::SequenceOfItems();
  sequence->SetLengthToUndefined();
  for (const DataSet& nested : items) {
    gdcm::Item item;
    item.SetVLToUndefined();
    item.SetNestedDataSet(nested);
    sequence->AddItem(item);
  }
  gdcm::DataElement element(tag);
  element.SetVR(VR::SQ);
  element.SetValue(*sequence);
  element.SetVLToUndefined();
  data.Replace(element);
}

inline std::string Position(const WorldPoint& p) {
  return absl::StrFormat("%g\\%g\\%g", p[0], p[1], p[2]);
}

inline const Tag kRows(0x28, 0x10), kPixelSpacing(0x28, 0x30), kPosition(0x20, 0x32);
inline const Tag kOrientation(0x20, 0x37), kPixels(0x7fe0, 0x10), kSeries(0x20, 0xe);

// A plane of kX * kY unsigned values of 16 bits; those of slice z begin at 6 * z.
inline DataSet Slice(const WorldPoint& position, int first_value) {
  DataSet data;
  Put(data, Tag(8, 0x16), VR::UI, "1.2.840.10008.5.1.4.1.1.2");
  Put(data, Tag(8, 0x18), VR::UI, absl::StrFormat("1.2.3.%d", first_value + 1));
  Put(data, Tag(8, 0x60), VR::CS, "CT");
  Put(data, Tag(8, 0x103e), VR::LO, "Thorax");
  Put(data, kSeries, VR::UI, "1.2.3.4");
  Put(data, Tag(0x20, 0x11), VR::IS, "3");
  Put(data, kPosition, VR::DS, Position(position));
  Put(data, kOrientation, VR::DS, "1\\0\\0\\0\\1\\0");
  PutShort(data, Tag(0x28, 2), 1);
  Put(data, Tag(0x28, 4), VR::CS, "MONOCHROME2");
  PutShort(data, kRows, kY);
  PutShort(data, Tag(0x28, 0x11), kX);
  Put(data, kPixelSpacing, VR::DS, "0.5\\0.25");
  PutShort(data, Tag(0x28, 0x100), 16);
  PutShort(data, Tag(0x28, 0x101), 16);
  PutShort(data, Tag(0x28, 0x102), 15);
  PutShort(data, Tag(0x28, 0x103), 0);
  std::string pixels;
  for (int n = 0; n < kX * kY; ++n) {
    pixels += static_cast<char>(first_value + n);
    pixels += '\0';
  }
  Put(data, kPixels, VR::OW, pixels);
  return data;
}

inline void Write(const std::string& path, const DataSet& data) {
  gdcm::Writer writer;
  writer.SetFileName(path.c_str());
  writer.GetFile().SetDataSet(data);
  gdcm::FileMetaInformation& header = writer.GetFile().GetHeader();
  header.SetDataSetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  header.FillFromDataSet(data);
  ASSERT_TRUE(writer.Write()) << path;
}

inline DataSet WithItem(const Tag& group, const Tag& tag, VR::VRType vr, const std::string& value) {
  DataSet nested, data;
  Put(nested, tag, vr, value);
  PutItems(data, group, {nested});
  return data;
}

}  // namespace bccskel::testing::dicom

#endif  // BCCSKEL_TESTS_CORE_IMPORT_IMAGE_DICOM_FILES_H_
