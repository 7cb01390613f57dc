#ifndef BCCSKEL_CORE_IMPORT_IMAGE_OPEN_IMAGE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_OPEN_IMAGE_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// True when the name ends like that of an image that is read: .nii, .hdr, .img, .nrrd, .nhdr, .tif,
// .tiff, .mha, .mhd, .inr, .npy, .npz, .vol, .raw, .dcm, .png, each also with .gz behind it; for
// every folder; and for .jpg, .jpeg and .bmp, which OpenImage() refuses with what to do.
bool IsImagePath(std::string_view path);

// Whether a file of any name has the first bytes of NIfTI, NRRD, TIFF, PNG, MetaImage, Inrimage,
// npy or DICOM; it may be compressed by gzip. False for what cannot be read.
bool BeginsLikeImage(const std::string& path);

// Opens NIfTI (1 and 2, also .hdr and .img), NRRD, TIFF, PNG, MetaImage, Inrimage, npy, npz, vol
// or, with options.raw, any bytes; the content determines which. A folder is opened as OME-Zarr, a
// Zarr array, a Neuroglancer precomputed volume or a series of PNG or TIFF slices. Reads the header
// and compares it with the file's length and the limits before any memory is taken for voxels.
// Errors: NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT (malformed, truncated, several channels);
//         RESOURCE_EXHAUSTED (over a limit); UNIMPLEMENTED (an unsupported part of the format).
//         Messages name the file.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenImage(const std::string& path,
                                                       const ImageOptions& options = {});

// Whether images of the format that the path leads to have what `options` choose of it: a channel,
// a time point, a level, a series. OK if the format does not say. OpenImage() checks the number.
// Errors: INVALID_ARGUMENT.
absl::Status CheckImageChoice(const std::string& path, const ImageOptions& options);

// The same for bytes in memory; `name` is used in messages.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenImageBytes(std::string name, std::string bytes,
                                                            const ImageOptions& options = {});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_OPEN_IMAGE_H_
