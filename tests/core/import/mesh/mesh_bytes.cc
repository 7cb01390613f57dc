#include "tests/core/import/mesh/mesh_bytes.h"

#include <zlib.h>

#include "absl/strings/escaping.h"

namespace bccskel::testing {

std::string Base64(const std::string& bytes) { return absl::Base64Escape(bytes); }

std::string Deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string stored(size, '\0');
  compress(reinterpret_cast<Bytef*>(stored.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  stored.resize(size);
  return stored;
}

}  // namespace bccskel::testing
