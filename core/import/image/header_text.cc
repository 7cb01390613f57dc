#include "core/import/image/header_text.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

std::string_view Trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

std::string LowerCase(std::string_view text) { return absl::AsciiStrToLower(std::string(text)); }

std::vector<std::string_view> Words(std::string_view text, std::string_view separators) {
  const std::string stops = std::string(kBlanks) + std::string(separators);
  std::vector<std::string_view> words;
  for (size_t begin = text.find_first_not_of(stops); begin != text.npos;) {
    const size_t end = std::min(text.find_first_of(stops, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(stops, end);
  }
  return words;
}

std::optional<std::pair<std::string_view, std::string_view>> SplitAt(std::string_view line,
                                                                     std::string_view separator) {
  const size_t at = line.find(separator);
  if (at == line.npos) return std::nullopt;
  return std::pair(Trimmed(line.substr(0, at)), Trimmed(line.substr(at + separator.size())));
}

absl::StatusOr<HeaderFields> HeaderFields::Read(std::string_view text, const HeaderSyntax& syntax) {
  HeaderFields header;
  for (size_t begin = 0; begin < text.size() && !header.bytes_.has_value();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    begin = std::min(end + 1, text.size());
    const HeaderLine kind = syntax.classify(line);
    if (kind == HeaderLine::kField || kind == HeaderLine::kLastField) {
      if (absl::Status status = header.Add(line, syntax.separator); !status.ok()) return status;
    }
    if (kind == HeaderLine::kEnd || kind == HeaderLine::kLastField) header.bytes_ = begin;
  }
  return header;
}

absl::Status HeaderFields::Add(std::string_view line, std::string_view separator) {
  const auto field = SplitAt(line, separator);
  if (!field.has_value()) return BadField("the header line", line, "is not a field");
  if (fields_.insert(*field).second) return absl::OkStatus();
  return BadField("the field", field->first, "is there twice");
}

std::optional<std::string_view> HeaderFields::Find(
    std::initializer_list<std::string_view> keys) const {
  for (const std::string_view key : keys) {
    if (const auto field = fields_.find(key); field != fields_.end()) return field->second;
  }
  return std::nullopt;
}

absl::StatusOr<std::string_view> HeaderFields::Require(
    std::initializer_list<std::string_view> keys) const {
  const std::optional<std::string_view> value = Find(keys);
  if (value.has_value()) return *value;
  return absl::InvalidArgumentError(
      absl::StrFormat("the header lacks '%s'", std::string(*keys.begin())));
}

absl::StatusOr<size_t> HeaderFields::Bytes() const {
  if (bytes_.has_value()) return *bytes_;
  return absl::InvalidArgumentError("the header has no end");
}

absl::Status BadField(std::string_view what, std::string_view value, std::string_view why) {
  constexpr size_t kShown = 80;
  return absl::InvalidArgumentError(
      absl::StrFormat("%s '%s' %s", std::string(what),
                      absl::CHexEscape(std::string(value.substr(0, kShown))), std::string(why)));
}

}  // namespace bccskel
