#include "server/jobs/chunk_checksum.h"

#include "absl/strings/str_cat.h"
#include "core/digest/crc32c.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

absl::Status CheckChunk(const std::string& bytes, std::optional<uint32_t> crc32c) {
  if (!crc32c.has_value() || *crc32c == Crc32c(bytes)) return absl::OkStatus();
  return CallError(
      Reason::kChunkChecksum,
      absl::StrCat("the chunk's CRC-32C is ", Crc32c(bytes), ", the request states ", *crc32c),
      {.field = "chunk.crc32c"});
}

}  // namespace bccskel::server
