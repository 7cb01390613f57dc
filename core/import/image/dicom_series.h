#ifndef BCCSKEL_CORE_IMPORT_IMAGE_DICOM_SERIES_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_DICOM_SERIES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/dicom_header.h"
#include "core/import/image/image_options.h"

namespace bccskel {

// The headers of a file, or of the files of one series in a folder; at least one, all of images.
// Errors: those of ReadDicomHeader(); INVALID_ARGUMENT, with the series there are, for several
//         without ImageOptions::series and for one that is not there.
absl::StatusOr<std::vector<DicomHeader>> DicomFilesOf(const std::string& path,
                                                      const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_DICOM_SERIES_H_
