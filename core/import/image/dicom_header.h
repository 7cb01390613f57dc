#ifndef BCCSKEL_CORE_IMPORT_IMAGE_DICOM_HEADER_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_DICOM_HEADER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/dicom_stack.h"
#include "core/import/image/image_options.h"

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

// The headers of a file, or of the files of one series in a folder; at least one, all of images.
// Errors: those of ReadDicomHeader(); INVALID_ARGUMENT, with the series there are, for several
//         without ImageOptions::series and for one that is not there.
absl::StatusOr<std::vector<DicomHeader>> DicomFilesOf(const std::string& path,
                                                      const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_DICOM_HEADER_H_
