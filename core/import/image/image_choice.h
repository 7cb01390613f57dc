#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_CHOICE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_CHOICE_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/import/image/image_options.h"

namespace bccskel {

// The channel (axis 'C') or point of time ('T') that the options choose out of `length`; 0 where
// they choose none of one.
// Errors: INVALID_ARGUMENT for none of several, and for one that is not there.
absl::StatusOr<int64_t> ChosenAlong(char axis, int64_t length, const ImageOptions& options);

// The level of a pyramid of `levels`; without a choice the first, which is the finest.
// Errors: INVALID_ARGUMENT for one that is not there.
absl::StatusOr<int64_t> ChosenLevel(int64_t levels, const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_CHOICE_H_
