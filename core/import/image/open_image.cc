#include "core/import/image/open_image.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"
#include "core/import/image/image_readers.h"
#include "core/import/image/slice_series.h"
#include "core/import/image/stored_image.h"
#include "core/import/image/zip_archive.h"

namespace bccskel {
namespace {

// Each also with .gz behind it. Pictures of the last three kinds are refused with what to do.
constexpr std::array<std::string_view, 19> kEndings = {
    ".nii", ".hdr", ".img", ".nrrd", ".nhdr", ".tif", ".tiff", ".mha",  ".mhd", ".inr",
    ".npy", ".npz", ".vol", ".raw",  ".dcm",  ".png", ".jpg",  ".jpeg", ".bmp"};

struct Format {
  bool (*is)(std::string_view front);
  absl::StatusOr<StoredImage> (*parse)(const ImageFront& front, const ImageLimits& limits);
};
// The vaguest marks last.
constexpr std::array<Format, 6> kFormats = {{
    {IsNrrd, ParseNrrd},
    {IsNpy, ParseNpy},
    {IsInrimage, ParseInrimage},
    {IsNifti, ParseNifti},
    {IsMetaImage, ParseMetaImage},
    {IsVol, ParseVol},
}};

absl::StatusOr<StoredImage> ParseRaw(const ImageFront& front, const RawLayout& raw,
                                     const ImageLimits& limits) {
  StoredImage image;
  image.info.format = "raw";
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, SizeOfAxes(raw.size, limits));
  image.stored_type = raw.type;
  image.byte_order = raw.byte_order;
  BCCSKEL_RETURN_IF_ERROR(PlaceBehindHeader(front, raw.header_bytes, Compression::kNone, image));
  const uint64_t bytes = raw.header_bytes + image.VoxelBytesDeclared();
  if (front.compression != Compression::kNone || front.file->size() == bytes) return image;
  return absl::InvalidArgumentError(
      absl::StrFormat("--raw-size, --raw-type and --raw-header make %d bytes, the file holds %d",
                      bytes, front.file->size()));
}

absl::StatusOr<StoredImage> ParseStored(const ImageFront& front, const ImageOptions& options) {
  if (options.raw.has_value()) return ParseRaw(front, *options.raw, options.limits);
  if (front.bytes.empty()) return absl::InvalidArgumentError("the file is empty");
  for (const Format& format : kFormats) {
    if (format.is(front.bytes)) return format.parse(front, options.limits);
  }
  if (front.bytes.starts_with("\xff\xd8\xff")) {
    return absl::InvalidArgumentError(
        "JPEG is not supported: it changes values, so masks and labels are no longer what they "
        "were; save the image as PNG or TIFF where it was made");
  }
  return absl::InvalidArgumentError(
      "format not supported: images are read from NIfTI, NRRD, TIFF, PNG, MetaImage, Inrimage, "
      "npy, npz and vol; raw voxels need --raw-size and --raw-type; save another image as NIfTI or "
      "NRRD, which keep its place, or as TIFF, PNG or .npy");
}

// What images of a format may have several of.
struct Choices {
  bool pages = false;  // channels and time points
  bool levels = false;
  bool series = false;
  bool arrays = false;
};
constexpr Choices kZarrChoices = {.pages = true, .levels = true};
constexpr Choices kDicomChoices = {.pages = true, .series = true};  // pages: segments

absl::Status CheckChoices(const Choices& there, const ImageOptions& options) {
  if (options.level.has_value() && !there.levels) {
    return absl::InvalidArgumentError("--level applies only to OME-Zarr and precomputed folders");
  }
  if (options.series.has_value() && !there.series) {
    return absl::InvalidArgumentError("--series applies only to folders of DICOM files");
  }
  if (options.array.has_value() && !there.arrays) {
    return absl::InvalidArgumentError("--array applies only to .npz files");
  }
  if ((options.channel.has_value() || options.time.has_value()) && !there.pages) {
    return absl::InvalidArgumentError("--channel and --time apply only to TIFF and OME-Zarr");
  }
  return absl::OkStatus();
}

// What most headers need: what is expanded to look for a longer one is expanded again for voxels.
constexpr uint64_t kShortFront = uint64_t{1} << 14;

// Headers of NRRD may end with their file, so that a part of one looks whole.
absl::StatusOr<StoredImage> ParseFront(const ImageFront& front,
                                       const std::shared_ptr<const ImageFile>& file,
                                       const ImageOptions& options) {
  absl::StatusOr<StoredImage> image = ParseStored(front, options);
  if (front.bytes.size() < kShortFront || (image.ok() && !IsNrrd(front.bytes))) return image;
  BCCSKEL_ASSIGN_OR_RETURN(const ImageFront whole, ReadFront(file, options.limits));
  return ParseStored(whole, options);
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenFile(std::shared_ptr<const ImageFile> file,
                                                      const ImageOptions& options) {
  ImageLimits limits = options.limits;
  limits.max_header_bytes = std::min(limits.max_header_bytes, kShortFront);
  BCCSKEL_ASSIGN_OR_RETURN(const ImageFront front, ReadFront(file, limits));
  const bool named = !options.raw.has_value(), tiff = named && IsTiff(front.bytes),
             png = named && IsPng(front.bytes), npz = named && IsZip(front.bytes);
  BCCSKEL_RETURN_IF_ERROR(CheckChoices({.pages = tiff, .arrays = npz}, options));
  if (tiff || png || npz) {
    BCCSKEL_ASSIGN_OR_RETURN(file, Expanded(std::move(file), front.compression));
  }
  if (tiff) return OpenTiff(std::move(file), options);
  if (png) return OpenPng(std::move(file), options);
  BCCSKEL_ASSIGN_OR_RETURN(StoredImage image, npz ? ParseNpz(file, options.array, options.limits)
                                                  : ParseFront(front, file, options));
  return OpenStoredImage(std::move(image), options.limits);
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenSlice(const std::string& path,
                                                       const ImageOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(auto file, ImageFile::Open(path));
  return OpenFile(std::move(file), options);
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenFolder(const std::string& path,
                                                        const ImageOptions& options) {
  if (options.raw.has_value()) {
    return absl::InvalidArgumentError("is a folder; raw voxels are read from files");
  }
  const bool zarr = IsZarrFolder(path), precomputed = IsPrecomputedFolder(path);
  if (!zarr && !precomputed && IsDicomFolder(path)) return OpenDicom(path, options);
  if (zarr || precomputed) {
    BCCSKEL_RETURN_IF_ERROR(CheckChoices(zarr ? kZarrChoices : Choices{.levels = true}, options));
    return zarr ? OpenZarr(path, options) : OpenPrecomputed(path, options);
  }
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<std::string> slices, InOrderOfNumbers(SliceNamesIn(path)));
  if (!slices.empty()) {
    return OpenSeries(std::move(slices), options.limits, [path, options](const std::string& name) {
      return OpenSlice(path + "/" + name, options);
    });
  }
  return absl::InvalidArgumentError(
      "is a folder, but neither of OME-Zarr (with zarr.json, .zattrs or .zarray) nor precomputed "
      "(with info) "
      "nor of DICOM, PNG or TIFF files");
}

// Every error names the image, and no exception leaves.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenNamed(
    const std::string& name, const ImageOptions& options,
    const std::function<absl::StatusOr<std::unique_ptr<ImageSource>>()>& open) {
  try {
    auto source = open();
    absl::Status status = source.status();
    if (status.ok() && options.spacing.has_value()) {
      status = (*source)->SetSpacing(*options.spacing);
    }
    if (status.ok() && options.unit.has_value()) (*source)->SetUnit(*options.unit);
    if (status.ok()) return source;
    return absl::Status(status.code(), absl::StrFormat("image '%s': %s", name, status.message()));
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(absl::StrFormat("image '%s': not enough memory", name));
  }
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenNamedFile(std::shared_ptr<const ImageFile> file,
                                                           const ImageOptions& options) {
  return OpenNamed(file->name(), options, [&] { return OpenFile(file, options); });
}

// Whatever its name.
bool StartsLikeTiff(const std::string& path) {
  std::error_code ignored;  // a pipe would wait for its writer
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::string front(8, '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(front.data(), static_cast<std::streamsize>(front.size())) && IsTiff(front);
}

// "scan.nii.gz" -> "scan.nii", in small letters.
std::string ExpandedName(std::string_view path) {
  std::string name = LowerCase(path);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name;
}

bool IsFolder(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

// The header of a pair that is named by its voxels: "brain.hdr" for "brain.img".
std::optional<std::string> HeaderBeside(const std::string& path) {
  const std::string name = LowerCase(path);
  for (const std::string_view ending : {".img", ".img.gz"}) {
    if (!name.ends_with(ending)) continue;
    const std::string stem = path.substr(0, path.size() - ending.size());
    return stem + ".hdr" + std::string(ending.substr(4));
  }
  return std::nullopt;
}

}  // namespace

bool IsImagePath(std::string_view path) {
  if (IsFolder(std::string(path))) return true;
  const std::string name = ExpandedName(path);
  return std::ranges::any_of(kEndings,
                             [&name](std::string_view ending) { return name.ends_with(ending); });
}

bool BeginsLikeImage(const std::string& path) {
  std::error_code ignored;  // a pipe would wait for its writer
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  if (IsDicomFile(path)) return true;
  auto file = ImageFile::Open(path);
  if (!file.ok()) return false;
  const absl::StatusOr<ImageFront> front = ReadFront(*std::move(file), {.max_header_bytes = 4096});
  if (!front.ok()) return false;
  // Not the vague marks, such as a number that may stand anywhere.
  const auto begins = [&front](bool (*is)(std::string_view)) { return is(front->bytes); };
  return begins(IsNrrd) || begins(IsNpy) || begins(IsInrimage) || begins(IsNifti) ||
         begins(IsTiff) || begins(IsPng) || front->bytes.starts_with("ObjectType");
}

absl::Status CheckImageChoice(const std::string& path, const ImageOptions& options) {
  if (options.raw.has_value()) return CheckChoices({}, options);
  if (IsFolder(path)) {
    if (IsZarrFolder(path)) return CheckChoices(kZarrChoices, options);
    if (IsPrecomputedFolder(path)) return CheckChoices({.levels = true}, options);
    if (IsDicomFolder(path)) return CheckChoices(kDicomChoices, options);
    const std::vector<std::string> slices = SliceNamesIn(path);
    if (slices.empty()) return absl::OkStatus();
    return CheckChoices({.pages = IsTiffName(slices.front())}, options);
  }
  const std::string name = ExpandedName(path);
  if (name.ends_with(".dcm") || IsDicomFile(path)) return CheckChoices(kDicomChoices, options);
  if (!IsImagePath(path)) return absl::OkStatus();
  const bool tiff = name.ends_with(".tif") || name.ends_with(".tiff") || StartsLikeTiff(path);
  return CheckChoices({.pages = tiff, .arrays = name.ends_with(".npz")}, options);
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenImage(const std::string& path,
                                                       const ImageOptions& options) {
  if (IsFolder(path)) {
    return OpenNamed(path, options, [&] { return OpenFolder(path, options); });
  }
  if (!options.raw.has_value() && IsDicomFile(path)) {
    return OpenNamed(path, options, [&] { return OpenDicom(path, options); });
  }
  const std::optional<std::string> header =
      options.raw.has_value() ? std::nullopt : HeaderBeside(path);
  if (header.has_value()) {
    auto file = ImageFile::Open(*header);
    if (!absl::IsNotFound(file.status())) {
      BCCSKEL_RETURN_IF_ERROR(file.status());
      return OpenNamedFile(*std::move(file), options);
    }
  }
  BCCSKEL_ASSIGN_OR_RETURN(auto file, ImageFile::Open(path));
  return OpenNamedFile(std::move(file), options);
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenImageBytes(std::string name, std::string bytes,
                                                            const ImageOptions& options) {
  return OpenNamedFile(ImageFile::OfBytes(std::move(name), std::move(bytes)), options);
}

}  // namespace bccskel
