#ifndef BCCSKEL_CORE_IMPORT_IMAGE_PRECOMPUTED_IMAGE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_PRECOMPUTED_IMAGE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// True for a folder with a file `info`.
bool IsPrecomputedFolder(const std::string& folder);

// The chosen level of a Neuroglancer precomputed volume in nanometers; chunks raw or as compressed
// segmentation, each file also compressed by gzip, with or without .gz behind its name.
// Errors: INVALID_ARGUMENT (malformed, a level that is not there), RESOURCE_EXHAUSTED (over a
//         limit), UNIMPLEMENTED (shards, several channels, other encodings and types).
absl::StatusOr<std::unique_ptr<ImageSource>> OpenPrecomputed(const std::string& folder,
                                                             const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_PRECOMPUTED_IMAGE_H_
