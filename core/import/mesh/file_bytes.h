#ifndef BCCSKEL_CORE_IMPORT_MESH_FILE_BYTES_H_
#define BCCSKEL_CORE_IMPORT_MESH_FILE_BYTES_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

namespace bccskel {

// The content of a file; gzip is recognized by its magic number, not by the name, and expanded.
// Units:   max_bytes counts expanded bytes; memory never exceeds it by more than one read.
// Errors:  NOT_FOUND, PERMISSION_DENIED, INVALID_ARGUMENT (a folder, a damaged or cut gzip stream),
//          RESOURCE_EXHAUSTED (more than max_bytes).
absl::StatusOr<std::string> ReadFileBytes(const std::string& path, uint64_t max_bytes);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_FILE_BYTES_H_
