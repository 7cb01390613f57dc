#ifndef BCCSKEL_SERVER_JOBS_CHUNK_CHECKSUM_H_
#define BCCSKEL_SERVER_JOBS_CHUNK_CHECKSUM_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// Errors: INVALID_ARGUMENT if the sender states another CRC-32C than that of the bytes.
absl::Status CheckChunk(const std::string& bytes, std::optional<uint32_t> crc32c);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_CHUNK_CHECKSUM_H_
