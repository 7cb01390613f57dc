#include "server/store/stored_status.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "absl/strings/cord.h"

namespace bccskel::server {
namespace {

constexpr int kLengthBytes = 4;

void AddNumber(size_t number, std::string& bytes) {
  for (int n = 0; n < kLengthBytes; ++n) bytes.push_back(static_cast<char>(number >> (8 * n)));
}

void AddText(std::string_view text, std::string& bytes) {
  AddNumber(text.size(), bytes);
  bytes.append(text);
}

std::optional<size_t> TakeNumber(std::string_view& bytes) {
  if (bytes.size() < kLengthBytes) return std::nullopt;
  size_t number = 0;
  for (int n = 0; n < kLengthBytes; ++n) {
    number |= size_t{static_cast<uint8_t>(bytes[static_cast<size_t>(n)])} << (8 * n);
  }
  bytes.remove_prefix(kLengthBytes);
  return number;
}

std::optional<std::string> TakeText(std::string_view& bytes) {
  const std::optional<size_t> size = TakeNumber(bytes);
  if (!size.has_value() || *size > bytes.size()) return std::nullopt;
  const std::string text(bytes.substr(0, *size));
  bytes.remove_prefix(*size);
  return text;
}

absl::Status Damaged() { return absl::DataLossError("a stored error is damaged"); }

}  // namespace

std::string BytesOf(const absl::Status& status) {
  std::string bytes;
  if (status.ok()) return bytes;
  AddNumber(static_cast<size_t>(status.raw_code()), bytes);
  AddText(std::string_view(status.message().data(), status.message().size()), bytes);
  // They come in no order of their own.
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
  const std::optional<size_t> code = TakeNumber(bytes);
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

}  // namespace bccskel::server
