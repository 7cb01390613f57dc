#ifndef BCCSKEL_SERVER_STORE_STORED_BYTES_H_
#define BCCSKEL_SERVER_STORE_STORED_BYTES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "server/store/sql_database.h"

namespace bccskel::server {

// Little-endian numbers, as in files.
template <typename Unsigned>
void AppendNumber(Unsigned value, std::string& bytes) {
  for (size_t n = 0; n < sizeof(Unsigned); ++n) {
    bytes.push_back(static_cast<char>(static_cast<uint8_t>(value >> (8 * n))));
  }
}
// Needs: offset + sizeof(Unsigned) <= bytes.size().
template <typename Unsigned>
Unsigned NumberAt(std::string_view bytes, size_t offset) {
  uint64_t value = 0;
  for (size_t n = 0; n < sizeof(Unsigned); ++n) {
    value |= uint64_t{static_cast<uint8_t>(bytes[offset + n])} << (8 * n);
  }
  return static_cast<Unsigned>(value);
}

// A status with its payloads as bytes, and back. OK is the empty string.
std::string BytesOf(const absl::Status& status);
// DATA_LOSS for bytes that BytesOf() never yields.
absl::Status StatusOfBytes(const std::string& bytes);

// Appends the bytes of the value that enter its row's checksum. The numbers of the kinds are part
// of it: they must never change.
void AppendChecked(const SqlValue& value, std::string& bytes);
// CRC-32C of the table's name and the row's columns.
int64_t ChecksumOf(const char* table, const std::vector<SqlValue>& values);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_STORED_BYTES_H_
