#ifndef BCCSKEL_CLIENT_EXPORT_LABEL_PATHS_H_
#define BCCSKEL_CLIENT_EXPORT_LABEL_PATHS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::exporting {

// The placeholder for a label's number in a path: such a path means one file per label.
inline constexpr const char* kLabelPlace = "{label}";

bool IsForEachLabel(const std::string& path);

// The label's own path. Creates the folders that contain the number, and those below them. Errors:
// those of the system.
absl::StatusOr<std::string> MakePathFor(const std::string& path, uint64_t label);

// OK for a path with kLabelPlace, and for one without it and a format that can hold many skeletons.
// Errors: INVALID_ARGUMENT.
absl::Status CheckLabelOutput(const std::string& path);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_LABEL_PATHS_H_
