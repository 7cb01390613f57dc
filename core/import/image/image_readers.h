#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_READERS_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_READERS_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/image/image_file.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// The readers of the formats whose voxels do not lie in order behind a header (these are in
// image_headers.h); open_image.h chooses between them.

bool IsTiff(std::string_view front);

// A stack of pages of one size and type; strips and tiles, all compressions of libtiff, BigTIFF.
// Which page is which slice, spacing and unit: TiffStackOf(). Values are those that are stored,
// regardless of the photometric interpretation: bilevel pages give 0 and 1, palettes indices.
// Errors: INVALID_ARGUMENT (damaged or cut, pages that differ, several samples per pixel, other
//         widths of samples), RESOURCE_EXHAUSTED (over a limit), and those of TiffStackOf().
absl::StatusOr<std::unique_ptr<ImageSource>> OpenTiff(std::shared_ptr<const ImageFile> file,
                                                      const ImageOptions& options);

bool IsPng(std::string_view front);

// Opens a PNG file, an image of one slice. Values are as stored: gray levels of 1 to 16 bits, the
// indices of a palette, and the one value of red, green and blue where these are equal in every
// pixel. The spacing is 1 or that of the options, since the density that a file states is mostly
// that of a screen.
// Errors: INVALID_ARGUMENT (damaged, cut, too short for its size; when its slice is read also a
//         pixel that is colored or transparent, with its place), RESOURCE_EXHAUSTED.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenPng(std::shared_ptr<const ImageFile> file,
                                                     const ImageOptions& options);

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

// True for a folder that Zarr writes, of version 2 or 3.
bool IsZarrFolder(const std::string& folder);

// The chosen level, channel and point of time of an OME-Zarr image (versions 0.1 to 0.5), or a Zarr
// array of version 2 or 3. Axes that an array does not name are t, c, z, y, x or the last of these.
// Errors: those of ParseZarrArray(), ParseMultiscales() and OpenChunkedImage(); INVALID_ARGUMENT
//         for several channels or points of time of which options choose none.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenZarr(const std::string& folder,
                                                      const ImageOptions& options);

// True for a folder with a file `info`.
bool IsPrecomputedFolder(const std::string& folder);

// The chosen level of a Neuroglancer precomputed volume in nanometers; chunks raw or as compressed
// segmentation, each file also compressed by gzip, with or without .gz behind its name.
// Errors: INVALID_ARGUMENT (malformed, a level that is not there), RESOURCE_EXHAUSTED (over a
//         limit), UNIMPLEMENTED (shards, several channels, other encodings and types).
absl::StatusOr<std::unique_ptr<ImageSource>> OpenPrecomputed(const std::string& folder,
                                                             const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_READERS_H_
