#ifndef BCCSKEL_CLIENT_EXPORT_ATOMIC_FILE_H_
#define BCCSKEL_CLIENT_EXPORT_ATOMIC_FILE_H_

#include <stop_token>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace bccskel::exporting {

// Writes a file atomically: readers of `path` see the old bytes or the new ones. Writes directly to
// anything that is not a regular file, such as /dev/null or a pipe.
// Errors: NOT_FOUND, PERMISSION_DENIED, RESOURCE_EXHAUSTED (no space), UNKNOWN; each names the
//         path. CANCELLED after a stop request.
absl::Status WriteFileAtomically(const std::string& path, std::string_view bytes,
                                 const std::stop_token& stop = {});

// Whether WriteFileAtomically() can begin; leaves no trace. Errors: as above.
absl::Status CheckWritable(const std::string& path);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_ATOMIC_FILE_H_
