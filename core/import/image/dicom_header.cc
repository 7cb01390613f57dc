#include "core/import/image/dicom_header.h"

#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"

namespace bccskel {
namespace {

using gdcm::DataSet;
using gdcm::Tag;

// The names of DICOM's dictionary.
const Tag kSopClass(0x0008, 0x0016), kSeriesDescription(0x0008, 0x103e);
const Tag kSliceThickness(0x0018, 0x0050), kSpacingBetweenSlices(0x0018, 0x0088);
const Tag kSeriesUid(0x0020, 0x000e), kSeriesNumber(0x0020, 0x0011);
const Tag kImagePosition(0x0020, 0x0032), kImageOrientation(0x0020, 0x0037);
const Tag kPlanePositions(0x0020, 0x9113), kPlaneOrientations(0x0020, 0x9116);
const Tag kSamples(0x0028, 0x0002), kFrames(0x0028, 0x0008);
const Tag kRows(0x0028, 0x0010), kColumns(0x0028, 0x0011), kPixelSpacing(0x0028, 0x0030);
const Tag kPixelMeasures(0x0028, 0x9110);
const Tag kSegmentationType(0x0062, 0x0001), kSegmentIdentification(0x0062, 0x000a);
const Tag kSegmentNumber(0x0062, 0x000b);
const Tag kShared(0x5200, 0x9229), kPerFrame(0x5200, 0x9230);
const Tag kPixelData(0x7fe0, 0x0010);

constexpr std::string_view kSegmentationClass = "1.2.840.10008.5.1.4.1.1.66.4";

const gdcm::ByteValue* Bytes(const DataSet& data, const Tag& tag) {
  return data.FindDataElement(tag) ? data.GetDataElement(tag).GetByteValue() : nullptr;
}

// Empty where the element is missing.
std::string Text(const DataSet& data, const Tag& tag) {
  const gdcm::ByteValue* bytes = Bytes(data, tag);
  if (bytes == nullptr || bytes->GetPointer() == nullptr) return "";
  std::string text(bytes->GetPointer(), bytes->GetLength());
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return std::string(Trimmed(text));
}

std::optional<uint16_t> Short(const DataSet& data, const Tag& tag) {
  const gdcm::ByteValue* bytes = Bytes(data, tag);
  if (bytes == nullptr || bytes->GetLength() < 2) return std::nullopt;
  const auto at = [bytes](size_t n) { return static_cast<uint8_t>(bytes->GetPointer()[n]); };
  return static_cast<uint16_t>(at(0) | at(1) << 8);
}

// Items of a sequence; none where it is missing.
gdcm::SmartPointer<gdcm::SequenceOfItems> Items(const DataSet& data, const Tag& tag) {
  if (!data.FindDataElement(tag)) return nullptr;
  return data.GetDataElement(tag).GetValueAsSQ();
}

// The first item of a sequence of one.
const DataSet* Item(const DataSet* data, const Tag& tag) {
  if (data == nullptr) return nullptr;
  const auto items = Items(*data, tag);
  if (items == nullptr || items->GetNumberOfItems() == 0) return nullptr;
  return &items->GetItem(1).GetNestedDataSet();
}

// Where a frame's facts are: its own item, the shared one, or the file itself.
struct Places {
  const DataSet* own;
  const DataSet* shared;
  const DataSet* file;

  // Of the innermost place that has it.
  std::string TextOf(const Tag& group, const Tag& tag) const {
    for (const DataSet* place : {Item(own, group), Item(shared, group), file}) {
      if (place == nullptr) continue;
      std::string text = Text(*place, tag);
      if (!text.empty()) return text;
    }
    return "";
  }
};

template <size_t kCount>
absl::StatusOr<std::array<double, kCount>> Numbers(const char* what, const std::string& text) {
  const std::vector<std::string_view> words = Words(text, "\\");
  if (words.size() != kCount) {
    return BadField(what, text, absl::StrFormat("has not %d numbers", kCount));
  }
  std::array<double, kCount> numbers;
  for (size_t n = 0; n < kCount; ++n) {
    std::string_view word = words[n];
    if (word.starts_with('+')) word.remove_prefix(1);
    BCCSKEL_ASSIGN_OR_RETURN(numbers[n], RequireNumber<double>(what, word));
    if (!std::isfinite(numbers[n])) return BadField(what, text, "is not finite");
  }
  return numbers;
}

absl::Status ReadOrientation(const std::string& text, DicomFrame& frame) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto directions, Numbers<6>("ImageOrientationPatient", text));
  for (size_t n = 0; n < 3; ++n) {
    frame.along_row[n] = directions[n];
    frame.along_column[n] = directions[3 + n];
  }
  for (const WorldPoint* axis : {&frame.along_row, &frame.along_column}) {
    const double length = std::hypot((*axis)[0], (*axis)[1], (*axis)[2]);
    if (std::abs(length - 1) > 1e-2) {
      return BadField("ImageOrientationPatient", text, "does not hold unit vectors");
    }
  }
  return absl::OkStatus();
}

absl::Status ReadPlace(const Places& places, DicomFrame& frame) {
  const std::string position = places.TextOf(kPlanePositions, kImagePosition);
  const std::string orientation = places.TextOf(kPlaneOrientations, kImageOrientation);
  if (position.empty() || orientation.empty()) {
    return absl::InvalidArgumentError(
        "there is no ImagePositionPatient or no ImageOrientationPatient, so nobody knows where the "
        "slice lies");
  }
  BCCSKEL_ASSIGN_OR_RETURN(frame.position, Numbers<3>("ImagePositionPatient", position));
  BCCSKEL_RETURN_IF_ERROR(ReadOrientation(orientation, frame));
  const std::string spacing = places.TextOf(kPixelMeasures, kPixelSpacing);
  if (spacing.empty()) return absl::InvalidArgumentError("there is no PixelSpacing");
  BCCSKEL_ASSIGN_OR_RETURN(const auto steps, Numbers<2>("PixelSpacing", spacing));
  frame.spacing = {steps[1], steps[0]};  // the first is from row to row
  for (const Tag& tag : {kSpacingBetweenSlices, kSliceThickness}) {
    const std::string text = places.TextOf(kPixelMeasures, tag);
    if (text.empty() || frame.thickness > 0) continue;
    BCCSKEL_ASSIGN_OR_RETURN(const auto thickness, Numbers<1>("SliceThickness", text));
    frame.thickness = std::abs(thickness[0]);
  }
  return absl::OkStatus();
}

absl::StatusOr<uint32_t> CountFrames(const DataSet& data) {
  const std::string text = Text(data, kFrames);
  if (text.empty()) return 1;
  const std::optional<uint32_t> count = ParseNumber<uint32_t>(text);
  constexpr uint32_t kMostFrames = 1 << 24;
  if (count.has_value() && *count > 0 && *count <= kMostFrames) return *count;
  return BadField("NumberOfFrames", text, "is not a number of frames");
}

absl::StatusOr<uint32_t> SegmentOf(const Places& places) {
  for (const DataSet* place : {places.own, places.shared}) {
    const DataSet* item = Item(place, kSegmentIdentification);
    const std::optional<uint16_t> number =
        item == nullptr ? std::nullopt : Short(*item, kSegmentNumber);
    if (number.value_or(0) > 0) return *number;
  }
  return absl::InvalidArgumentError("a frame does not say which segment it is of");
}

absl::StatusOr<DicomKind> KindOf(const DataSet& data) {
  if (!Short(data, kRows).has_value()) return DicomKind::kOther;
  if (const uint16_t samples = Short(data, kSamples).value_or(1); samples != 1) {
    return absl::UnimplementedError(
        absl::StrFormat("%d samples a pixel: colors are not read", samples));
  }
  if (Text(data, kSopClass) != kSegmentationClass) return DicomKind::kImage;
  if (const std::string type = Text(data, kSegmentationType); type != "BINARY") {
    return absl::UnimplementedError(absl::StrFormat(
        "a segmentation of the type '%s' is not read, only BINARY", type.substr(0, 40)));
  }
  return DicomKind::kSegmentation;
}

absl::Status ReadFrames(const DataSet& data, DicomHeader& header) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint32_t count, CountFrames(data));
  const auto own = Items(data, kPerFrame);
  if (count > 1 && (own == nullptr || own->GetNumberOfItems() != count)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%d frames do not say each where it lies (PerFrameFunctionalGroupsSequence)", count));
  }
  const DataSet* shared = Item(&data, kShared);
  for (uint32_t n = 0; n < count; ++n) {
    const bool has_own = own != nullptr && n < own->GetNumberOfItems();
    const Places places = {has_own ? &own->GetItem(n + 1).GetNestedDataSet() : nullptr, shared,
                           &data};
    DicomFrame frame;
    frame.name = std::filesystem::path(header.path).filename().string();
    frame.index = n;
    frame.rows = Short(data, kRows).value_or(0);
    frame.columns = Short(data, kColumns).value_or(0);
    BCCSKEL_RETURN_IF_ERROR(ReadPlace(places, frame));
    if (header.kind == DicomKind::kSegmentation) {
      BCCSKEL_ASSIGN_OR_RETURN(frame.segment, SegmentOf(places));
    }
    header.frames.push_back(std::move(frame));
  }
  return absl::OkStatus();
}

absl::StatusOr<DicomHeader> Read(const std::string& path) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  if (!reader.ReadUpToTag(kPixelData, {kPixelData})) {
    return absl::InvalidArgumentError("the file is damaged or no DICOM");
  }
  const DataSet& data = reader.GetFile().GetDataSet();
  DicomHeader header;
  header.path = path;
  header.series = Text(data, kSeriesUid);
  header.series_number = Text(data, kSeriesNumber);
  header.series_description = Text(data, kSeriesDescription);
  BCCSKEL_ASSIGN_OR_RETURN(header.kind, KindOf(data));
  if (header.kind != DicomKind::kOther) BCCSKEL_RETURN_IF_ERROR(ReadFrames(data, header));
  return header;
}

}  // namespace

absl::StatusOr<DicomHeader> ReadDicomHeader(const std::string& path) {
  absl::Status failed;
  try {
    absl::StatusOr<DicomHeader> header = Read(path);
    if (header.ok()) return header;
    failed = header.status();
  } catch (const std::bad_alloc&) {
    throw;  // told by OpenImage()
  } catch (const std::exception& error) {
    failed = absl::InvalidArgumentError(std::string("the file is damaged: ") + error.what());
  }
  const std::string name = std::filesystem::path(path).filename().string();
  return absl::Status(failed.code(), absl::StrFormat("'%s': %s", name, failed.message()));
}

}  // namespace bccskel
