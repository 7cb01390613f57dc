#include "core/io/exr_attributes.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "absl/strings/escaping.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

constexpr size_t kMaxNameLength = 31;  // longer ones need a flag that the profile does not have

// Names come from untrusted bytes and end up in messages.
std::string Printable(std::string_view name) { return absl::CEscape({name.data(), name.size()}); }

std::optional<size_t> RuleIndex(std::string_view name) {
  const auto rule = std::ranges::find(kExrAttributeRules, name, &ExrAttributeRule::name);
  if (rule == kExrAttributeRules.end()) return std::nullopt;
  return static_cast<size_t>(rule - kExrAttributeRules.begin());
}

absl::Status TruncatedError(const ByteCursor& cursor) {
  return absl::InvalidArgumentError(absl::StrFormat(
      "OpenEXR header: malformed or cut off at byte %d (a header has at most 65536 bytes)",
      cursor.position()));
}

absl::Status CheckAgainstRule(const ExrAttributeRule& rule, std::string_view type, int32_t bytes) {
  if (type != rule.type) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "OpenEXR attribute %s has type '%s': must be %s", rule.name, Printable(type), rule.type));
  }
  if (bytes < 0 || (rule.bytes && static_cast<size_t>(bytes) != *rule.bytes)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("OpenEXR attribute %s has %d bytes: must have %d", rule.name, bytes,
                        rule.bytes.value_or(0)));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ExrAttributes> ExrAttributes::Read(ByteCursor& cursor) {
  ExrAttributes attributes;
  for (;;) {
    const auto name = cursor.TakeName(kMaxNameLength);
    if (!name) return TruncatedError(cursor);
    if (name->empty()) break;
    const auto type = cursor.TakeName(kMaxNameLength);
    const auto bytes = type ? cursor.TakeNumber<int32_t>() : std::nullopt;
    if (!bytes) return TruncatedError(cursor);
    const auto index = RuleIndex(*name);
    if (!index) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "OpenEXR attribute '%s': the volume profile has no such attribute", Printable(*name)));
    }
    BCCSKEL_RETURN_IF_ERROR(CheckAgainstRule(kExrAttributeRules[*index], *type, *bytes));
    if (attributes.values_[*index]) {
      return absl::InvalidArgumentError(
          absl::StrFormat("OpenEXR attribute %s is given twice", Printable(*name)));
    }
    attributes.values_[*index] = cursor.Take(static_cast<size_t>(*bytes));
    if (!attributes.values_[*index]) return TruncatedError(cursor);
  }
  BCCSKEL_RETURN_IF_ERROR(attributes.CheckComplete());
  return attributes;
}

std::optional<std::span<const std::byte>> ExrAttributes::Find(std::string_view name) const {
  const auto index = RuleIndex(name);
  return index ? values_[*index] : std::nullopt;
}

absl::Status ExrAttributes::CheckComplete() const {
  for (size_t n = 0; n < values_.size(); ++n) {
    if (kExrAttributeRules[n].need == ExrAttributeNeed::kRequired && !values_[n]) {
      return absl::InvalidArgumentError(
          absl::StrFormat("OpenEXR attribute %s is missing", kExrAttributeRules[n].name));
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel
