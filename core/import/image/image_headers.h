#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_HEADERS_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_HEADERS_H_

// The headers of formats with one stream of voxels; open_image.h chooses between them. README.md
// explains why they are not left to libraries.

#include <bit>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/image_limits.h"
#include "core/import/image/stored_image.h"

namespace bccskel {

// The beginning of a file: at most ImageLimits::max_header_bytes of it, expanded if the file as a
// whole is compressed by gzip or is the member of a zip archive.
struct ImageFront {
  std::shared_ptr<const ImageFile> file;
  Compression compression = Compression::kNone;
  std::string bytes;
  uint64_t member = 0;  // of a zip archive
};

absl::StatusOr<ImageFront> ReadFront(std::shared_ptr<const ImageFile> file,
                                     const ImageLimits& limits);
// The beginning of a member of a zip archive.
absl::StatusOr<ImageFront> ReadMemberFront(std::shared_ptr<const ImageFile> file, uint64_t member,
                                           const ImageLimits& limits);

// The file without its compression as a whole, in memory: for what is read anywhere in a file, and
// for voxels that are compressed once more.
// Errors: RESOURCE_EXHAUSTED above 1 GiB.
absl::StatusOr<std::shared_ptr<const ImageFile>> Expanded(std::shared_ptr<const ImageFile> file,
                                                          Compression compression);

// Where the voxels begin, for a header that is followed by them. `inner` is the compression of
// the voxels alone. Errors: as Expanded().
absl::Status PlaceBehindHeader(const ImageFront& front, uint64_t header_bytes, Compression inner,
                               StoredImage& image);

// Voxels in a separate file beside the header, after `skip` bytes, or at its end without `skip`.
// Errors: as ImageFile::OpenBeside().
absl::Status PlaceInFile(const ImageFront& front, std::string_view name,
                         std::optional<uint64_t> skip, Compression inner, StoredImage& image);

// The same for a header that names the file and states, in the field `skip_field`, how many bytes
// to skip; -1: the voxels are at the end. Errors: also UNIMPLEMENTED for several files;
// INVALID_ARGUMENT for another `skip`.
absl::Status PlaceDetached(const ImageFront& front, std::string_view name,
                           std::string_view skip_field, std::string_view skip, Compression inner,
                           StoredImage& image);

// The type of a number by NumPy's name, such as "<u2"; nothing for what is not read.
struct NumpyType {
  VoxelType type = VoxelType::kUint8;
  std::endian byte_order = std::endian::little;
  StoredHalves halves = StoredHalves::kNo;
};
std::optional<NumpyType> NumpyTypeOf(std::string_view name);

// Does the file begin as the format does?
bool IsNifti(std::string_view front);
bool IsNrrd(std::string_view front);
bool IsMetaImage(std::string_view front);
bool IsInrimage(std::string_view front);
bool IsNpy(std::string_view front);
bool IsVol(std::string_view front);

// Errors of all: INVALID_ARGUMENT (malformed header, names the field and its value),
//                RESOURCE_EXHAUSTED (over a limit), UNIMPLEMENTED (what the format knows and we do
//                not read, such as voxels as text).
absl::StatusOr<StoredImage> ParseNifti(const ImageFront& front, const ImageLimits& limits);
absl::StatusOr<StoredImage> ParseNrrd(const ImageFront& front, const ImageLimits& limits);
absl::StatusOr<StoredImage> ParseMetaImage(const ImageFront& front, const ImageLimits& limits);
absl::StatusOr<StoredImage> ParseInrimage(const ImageFront& front, const ImageLimits& limits);
absl::StatusOr<StoredImage> ParseNpy(const ImageFront& front, const ImageLimits& limits);
absl::StatusOr<StoredImage> ParseVol(const ImageFront& front, const ImageLimits& limits);
// The array of that name, or the only one, of the zip archive of npy files that NumPy writes.
absl::StatusOr<StoredImage> ParseNpz(const std::shared_ptr<const ImageFile>& file,
                                     const std::optional<std::string>& array,
                                     const ImageLimits& limits);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_HEADERS_H_
