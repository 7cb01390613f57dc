#ifndef BCCSKEL_CORE_IMPORT_IMAGE_SLICE_SERIES_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_SLICE_SERIES_H_

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// The files of a folder, not those below it, that are named like slices: .png, .tif, .tiff.
// Hidden ones are none. Sorted by name.
std::vector<std::string> SliceNamesIn(const std::string& folder);
bool IsTiffName(std::string_view name);

// The names of slices in the order of their numbers.
// Needs:  names, sorted.
// Errors: INVALID_ARGUMENT for names of PNG and TIFF together, names that differ in more than one
//         number, and a number that is missing or there twice.
absl::StatusOr<std::vector<std::string>> InOrderOfNumbers(std::vector<std::string> names);

// Opens files of one slice each as one image; `open` opens a file by its name. A single file may
// have several slices. Placement, unit and type are those of the first.
// Needs:  names.
// Errors: those of `open`, SizeOfAxes() and NextSlice(); when a slice is read, INVALID_ARGUMENT
//         where its size or its type is not that of the first. Messages name the file.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenSeries(
    std::vector<std::string> names, const ImageLimits& limits,
    std::function<absl::StatusOr<std::unique_ptr<ImageSource>>(const std::string& name)> open);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_SLICE_SERIES_H_
