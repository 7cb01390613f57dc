#include "server/store/row_checksum.h"

#include "core/digest/crc32c.h"
#include "server/store/little_endian.h"

namespace bccskel::server {
namespace {

// SQLite's own.
char CodeOf(SqlValue::Kind kind) {
  constexpr char kInteger = 1, kText = 3, kBlob = 4;
  if (kind == SqlValue::Kind::kNumber) return kInteger;
  return kind == SqlValue::Kind::kText ? kText : kBlob;
}

}  // namespace

void AppendChecked(const SqlValue& value, std::string& bytes) {
  bytes.push_back(CodeOf(value.kind));
  if (value.kind == SqlValue::Kind::kNumber) {
    return AppendNumber(static_cast<uint64_t>(value.number), bytes);
  }
  AppendNumber(uint64_t{value.bytes.size()}, bytes);
  bytes.append(value.bytes);
}

int64_t ChecksumOf(const char* table, const std::vector<SqlValue>& values) {
  std::string bytes;
  AppendChecked(SqlValue::Text(table), bytes);
  for (const SqlValue& value : values) AppendChecked(value, bytes);
  return Crc32c(bytes);
}

}  // namespace bccskel::server
