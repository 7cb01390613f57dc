#ifndef BCCSKEL_CORE_IMPORT_IMAGE_DICOM_HEADER_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_DICOM_HEADER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/dicom_stack.h"

namespace bccskel {

enum class DicomKind : uint8_t {
  kImage,         // values
  kSegmentation,  // a bit for each voxel of a frame, which belongs to a segment
  kOther,         // no image at all: a report, a plan, ...
};

// What one file says of itself.
struct DicomHeader {
  std::string path;
  DicomKind kind = DicomKind::kOther;
  std::string series;  // its unique identifier
  std::string series_number;
  std::string series_description;
  std::vector<DicomFrame> frames;
};

// Reads everything before the voxels.
// Errors: INVALID_ARGUMENT for a damaged file and one without what images need (position,
//         orientation and pixel spacing); UNIMPLEMENTED for colors and
//         fractional segmentations. Messages name the file.
absl::StatusOr<DicomHeader> ReadDicomHeader(const std::string& path);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_DICOM_HEADER_H_
