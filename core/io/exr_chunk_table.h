#ifndef BCCSKEL_CORE_IO_EXR_CHUNK_TABLE_H_
#define BCCSKEL_CORE_IO_EXR_CHUNK_TABLE_H_

#include <cstddef>
#include <span>

#include "absl/status/status.h"
#include "core/io/exr_header.h"

namespace bccskel {

// Checks the chunk offset tables and the 12 bytes in front of every chunk of a whole file: each
// chunk lies where its table says, belongs to its part and line, has a size that its compression
// can have, and all chunks together fill the file to its last byte. OpenEXR itself would take a
// chunk of no bytes for one of whatever its buffer held before.
// Errors: INVALID_ARGUMENT.
absl::Status CheckExrChunks(std::span<const std::byte> file, const ExrHeader& header);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_EXR_CHUNK_TABLE_H_
