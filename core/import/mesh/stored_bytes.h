#ifndef BCCSKEL_CORE_IMPORT_MESH_STORED_BYTES_H_
#define BCCSKEL_CORE_IMPORT_MESH_STORED_BYTES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace bccskel {

// Bytes that a file holds as they are or in base64, taken from the front. What is decoded is no
// more than what is asked for, and never more than there is.
class StoredBytes {
 public:
  enum class Encoding { kRaw, kBase64 };

  // In base64, white space is skipped. What was encoded by itself and so ends with padding, as the
  // headers of VTK, must be taken by itself. `stored` must outlive this object.
  StoredBytes(std::string_view stored, Encoding encoding) : rest_(stored), encoding_(encoding) {}

  // Errors: INVALID_ARGUMENT when fewer follow, or for a character that is none of base64.
  absl::StatusOr<std::string> Take(uint64_t size);
  // All that follow.
  absl::StatusOr<std::string> TakeAll();

  // Bytes of the file that are still to be taken.
  size_t left() const { return rest_.size(); }

 private:
  absl::Status Decode(uint64_t wanted);

  std::string_view rest_;
  Encoding encoding_;
  std::string decoded_;  // and not taken yet
};

// Expands a stream of zlib or gzip that must hold exactly `size` bytes.
// Errors: INVALID_ARGUMENT (damaged, cut, longer, or a size that so few bytes cannot expand to).
absl::StatusOr<std::string> Inflate(std::string_view stored, uint64_t size);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_STORED_BYTES_H_
