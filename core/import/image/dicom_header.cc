#include "core/import/image/dicom_header.h"

#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/oflog/oflog.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"

namespace bccskel {
namespace {

constexpr std::string_view kSegmentationClass = "1.2.840.10008.5.1.4.1.1.66.4";

// Several values lie between backslashes. Empty where the element is missing.
std::string Text(DcmItem& data, const DcmTagKey& tag) {
  OFString text;
  if (data.findAndGetOFStringArray(tag, text).bad()) return "";
  return std::string(Trimmed(text.c_str()));
}

std::optional<uint16_t> Short(DcmItem& data, const DcmTagKey& tag) {
  Uint16 value = 0;
  if (data.findAndGetUint16(tag, value).bad()) return std::nullopt;
  return value;
}

// Null where the sequence is missing.
DcmSequenceOfItems* Items(DcmItem& data, const DcmTagKey& tag) {
  DcmSequenceOfItems* items = nullptr;
  return data.findAndGetSequence(tag, items).good() ? items : nullptr;
}

// The first item of a sequence of one.
DcmItem* Item(DcmItem* data, const DcmTagKey& tag) {
  DcmSequenceOfItems* items = data == nullptr ? nullptr : Items(*data, tag);
  return items == nullptr || items->card() == 0 ? nullptr : items->getItem(0);
}

// Where a frame's facts are: its own item, the shared one, or the file itself.
struct Places {
  DcmItem* own;
  DcmItem* shared;
  DcmItem* file;

  // Of the innermost place that has it.
  std::string TextOf(const DcmTagKey& group, const DcmTagKey& tag) const {
    for (DcmItem* place : {Item(own, group), Item(shared, group), file}) {
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
  const std::string position = places.TextOf(DCM_PlanePositionSequence, DCM_ImagePositionPatient);
  const std::string orientation =
      places.TextOf(DCM_PlaneOrientationSequence, DCM_ImageOrientationPatient);
  if (position.empty() || orientation.empty()) {
    return absl::InvalidArgumentError(
        "there is no ImagePositionPatient or no ImageOrientationPatient, so the position of the "
        "slice is unknown");
  }
  BCCSKEL_ASSIGN_OR_RETURN(frame.position, Numbers<3>("ImagePositionPatient", position));
  BCCSKEL_RETURN_IF_ERROR(ReadOrientation(orientation, frame));
  const std::string spacing = places.TextOf(DCM_PixelMeasuresSequence, DCM_PixelSpacing);
  if (spacing.empty()) return absl::InvalidArgumentError("there is no PixelSpacing");
  BCCSKEL_ASSIGN_OR_RETURN(const auto steps, Numbers<2>("PixelSpacing", spacing));
  frame.spacing = {steps[1], steps[0]};  // the first is from row to row
  for (const DcmTagKey& tag : {DCM_SpacingBetweenSlices, DCM_SliceThickness}) {
    const std::string text = places.TextOf(DCM_PixelMeasuresSequence, tag);
    if (text.empty() || frame.thickness > 0) continue;
    BCCSKEL_ASSIGN_OR_RETURN(const auto thickness, Numbers<1>("SliceThickness", text));
    frame.thickness = std::abs(thickness[0]);
  }
  return absl::OkStatus();
}

absl::StatusOr<uint32_t> CountFrames(DcmItem& data) {
  const std::string text = Text(data, DCM_NumberOfFrames);
  if (text.empty()) return 1;
  const std::optional<uint32_t> count = ParseNumber<uint32_t>(text);
  constexpr uint32_t kMostFrames = 1 << 24;
  if (count.has_value() && *count > 0 && *count <= kMostFrames) return *count;
  return BadField("NumberOfFrames", text, "is not a number of frames");
}

absl::StatusOr<uint32_t> SegmentOf(const Places& places) {
  for (DcmItem* place : {places.own, places.shared}) {
    DcmItem* item = Item(place, DCM_SegmentIdentificationSequence);
    const std::optional<uint16_t> number =
        item == nullptr ? std::nullopt : Short(*item, DCM_ReferencedSegmentNumber);
    if (number.value_or(0) > 0) return *number;
  }
  return absl::InvalidArgumentError("a frame does not say which segment it is of");
}

absl::StatusOr<DicomKind> KindOf(DcmItem& data) {
  if (!Short(data, DCM_Rows).has_value()) return DicomKind::kOther;
  if (const uint16_t samples = Short(data, DCM_SamplesPerPixel).value_or(1); samples != 1) {
    return absl::UnimplementedError(
        absl::StrFormat("%d samples a pixel: colors are not supported", samples));
  }
  if (Text(data, DCM_SOPClassUID) != kSegmentationClass) return DicomKind::kImage;
  if (const std::string type = Text(data, DCM_SegmentationType); type != "BINARY") {
    return absl::UnimplementedError(
        absl::StrFormat("a segmentation of the type '%s' is not supported, only BINARY is; "
                        "threshold it first, and store "
                        "it as a binary one, NIfTI or NRRD",
                        type.substr(0, 40)));
  }
  return DicomKind::kSegmentation;
}

absl::Status ReadFrames(DcmItem& data, DicomHeader& header) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint32_t count, CountFrames(data));
  DcmSequenceOfItems* const own = Items(data, DCM_PerFrameFunctionalGroupsSequence);
  if (count > 1 && (own == nullptr || own->card() != count)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%d frames do not say each where it lies (PerFrameFunctionalGroupsSequence)", count));
  }
  DcmItem* const shared = Item(&data, DCM_SharedFunctionalGroupsSequence);
  for (uint32_t n = 0; n < count; ++n) {
    const bool has_own = own != nullptr && n < own->card();
    const Places places = {has_own ? own->getItem(n) : nullptr, shared, &data};
    DicomFrame frame;
    frame.name = std::filesystem::path(header.path).filename().string();
    frame.index = n;
    frame.rows = Short(data, DCM_Rows).value_or(0);
    frame.columns = Short(data, DCM_Columns).value_or(0);
    BCCSKEL_RETURN_IF_ERROR(ReadPlace(places, frame));
    if (header.kind == DicomKind::kSegmentation) {
      BCCSKEL_ASSIGN_OR_RETURN(frame.segment, SegmentOf(places));
    }
    header.frames.push_back(std::move(frame));
  }
  return absl::OkStatus();
}

absl::StatusOr<DicomHeader> Read(const std::string& path) {
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  DcmFileFormat file;
  const OFCondition loaded = file.loadFileUntilTag(
      path.c_str(), EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_autoDetect, DCM_PixelData);
  if (loaded.bad()) {
    return absl::InvalidArgumentError(std::string("the file is damaged: ") + loaded.text());
  }
  DcmDataset& data = *file.getDataset();
  DicomHeader header;
  header.path = path;
  header.series = Text(data, DCM_SeriesInstanceUID);
  header.series_number = Text(data, DCM_SeriesNumber);
  header.series_description = Text(data, DCM_SeriesDescription);
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
