#include "core/import/image/image_readers.h"

namespace bccskel {

absl::StatusOr<std::unique_ptr<ImageSource>> OpenDicom(const std::string& /*path*/,
                                                       const ImageOptions& /*options*/) {
  return absl::UnimplementedError(
      "this is DICOM, which this build does not read; configure with -DBCCSKEL_DICOM=ON (Debian: "
      "libdcmtk-dev), or convert it to NIfTI or NRRD first");
}

}  // namespace bccskel
