#ifndef BCCSKEL_CORE_IMPORT_IMAGE_ZARR_IMAGE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_ZARR_IMAGE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// True for a folder that Zarr writes, of version 2 or 3.
bool IsZarrFolder(const std::string& folder);

// The chosen level, channel and point of time of an OME-Zarr image (versions 0.1 to 0.4), or a Zarr
// array of version 2, whose axes are then t, c, z, y, x or the last ones of these.
// Errors: those of ParseZarrArray(), ParseMultiscales() and OpenChunkedImage(); INVALID_ARGUMENT
//         for several channels or points of time of which options choose none; UNIMPLEMENTED for
//         version 3.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenZarr(const std::string& folder,
                                                      const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_ZARR_IMAGE_H_
