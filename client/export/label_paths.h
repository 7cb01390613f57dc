#ifndef BCCSKEL_CLIENT_EXPORT_LABEL_PATHS_H_
#define BCCSKEL_CLIENT_EXPORT_LABEL_PATHS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::exporting {

// What stands in a path for the number of a label: such a path is one file per label.
inline constexpr const char* kLabelPlace = "{label}";

bool IsForEachLabel(const std::string& path);

// The label's own path, in whose last folder a file can be made: folders that the number names, and
// those in them, are made. Errors: those of the system.
absl::StatusOr<std::string> MakePathFor(const std::string& path, uint64_t label);

// OK for a path with kLabelPlace and any format but pictures, and for one without and a format that
// can hold many skeletons. Errors: INVALID_ARGUMENT.
absl::Status CheckLabelOutput(const std::string& path);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_LABEL_PATHS_H_
