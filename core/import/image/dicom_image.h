#ifndef BCCSKEL_CORE_IMPORT_IMAGE_DICOM_IMAGE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_DICOM_IMAGE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// Whether a file has the mark of DICOM, and whether a folder has such a file.
bool IsDicomFile(const std::string& path);
bool IsDicomFolder(const std::string& path);

// Opens a series of slices in a folder, or a file: a slice, several frames, or a segmentation,
// whose segment numbers are labels. World: LPS, mm. Slices are sorted by their positions.
// Errors: INVALID_ARGUMENT for damaged files, several series without a choice
//         (ImageOptions::series), slices that are missing, doubled or unevenly spaced, and segments
//         that overlap where none is chosen (ImageOptions::channel); UNIMPLEMENTED for colors,
//         fractional segmentations, and without DCMTK (the build's option BCCSKEL_DICOM).
absl::StatusOr<std::unique_ptr<ImageSource>> OpenDicom(const std::string& path,
                                                       const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_DICOM_IMAGE_H_
