#ifndef BCCSKEL_CLIENT_EXPORT_ATOMIC_FILE_H_
#define BCCSKEL_CLIENT_EXPORT_ATOMIC_FILE_H_

#include <stop_token>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace bccskel::exporting {

// Writes a file as a whole or not at all: readers of `path` see the old bytes or the new ones.
// Something that is not a plain file, such as /dev/null or a pipe, is written to directly.
// Errors: NOT_FOUND, PERMISSION_DENIED, RESOURCE_EXHAUSTED (no space), UNKNOWN; each names the
// path. CANCELLED once a stop was asked for.
absl::Status WriteFileAtomically(const std::string& path, std::string_view bytes,
                                 const std::stop_token& stop = {});

// Whether WriteFileAtomically() can begin, without a trace. Errors: as above.
absl::Status CheckWritable(const std::string& path);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_ATOMIC_FILE_H_
