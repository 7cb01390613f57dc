#include "server/store/stored_bytes.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "absl/strings/cord.h"
#include "core/digest/crc32c.h"

namespace bccskel::server {
namespace {

void AddText(std::string_view text, std::string& bytes) {
  AppendNumber(static_cast<uint32_t>(text.size()), bytes);
  bytes.append(text);
}

std::optional<uint32_t> TakeNumber(std::string_view& bytes) {
  if (bytes.size() < sizeof(uint32_t)) return std::nullopt;
  const auto number = NumberAt<uint32_t>(bytes, 0);
  bytes.remove_prefix(sizeof(uint32_t));
  return number;
}

std::optional<std::string> TakeText(std::string_view& bytes) {
  const std::optional<uint32_t> size = TakeNumber(bytes);
  if (!size.has_value() || *size > bytes.size()) return std::nullopt;
  const std::string text(bytes.substr(0, *size));
  bytes.remove_prefix(*size);
  return text;
}

// SQLite's type codes.
char CodeOf(SqlValue::Kind kind) {
  constexpr char kInteger = 1, kText = 3, kBlob = 4;
  if (kind == SqlValue::Kind::kNumber) return kInteger;
  return kind == SqlValue::Kind::kText ? kText : kBlob;
}

absl::Status Damaged() { return absl::DataLossError("a stored error is damaged"); }

}  // namespace

std::string BytesOf(const absl::Status& status) {
  std::string bytes;
  if (status.ok()) return bytes;
  AppendNumber(static_cast<uint32_t>(status.raw_code()), bytes);
  AddText(std::string_view(status.message().data(), status.message().size()), bytes);
  // ForEachPayload() has no fixed order.
  std::map<std::string, std::string> payloads;
  status.ForEachPayload([&](const auto& url, const absl::Cord& payload) {
    payloads.emplace(std::string(url.data(), url.size()), std::string(payload));
  });
  for (const auto& [url, payload] : payloads) {
    AddText(url, bytes);
    AddText(payload, bytes);
  }
  return bytes;
}

absl::Status StatusOfBytes(const std::string& stored) {
  if (stored.empty()) return absl::OkStatus();
  std::string_view bytes = stored;
  const std::optional<uint32_t> code = TakeNumber(bytes);
  const std::optional<std::string> message = TakeText(bytes);
  if (!code.has_value() || *code == 0 || !message.has_value()) return Damaged();
  absl::Status status(static_cast<absl::StatusCode>(*code), *message);
  while (!bytes.empty()) {
    const std::optional<std::string> url = TakeText(bytes), payload = TakeText(bytes);
    if (!url.has_value() || !payload.has_value()) return Damaged();
    status.SetPayload(*url, absl::Cord(*payload));
  }
  return status;
}

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
