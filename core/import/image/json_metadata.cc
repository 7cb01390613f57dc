#include "core/import/image/json_metadata.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

constexpr int kMostNested = 64;

template <typename Item>
absl::StatusOr<std::vector<Item>> ListOf(std::string_view what, const Json& value,
                                         absl::StatusOr<Item> (*read)(std::string_view,
                                                                      const Json&)) {
  if (!value.is_array()) return BadValue(what, value, "is not a list");
  std::vector<Item> items;
  for (const Json& item : value) {
    BCCSKEL_ASSIGN_OR_RETURN(items.emplace_back(), read(what, item));
  }
  return items;
}

}  // namespace

absl::StatusOr<std::optional<Json>> ReadJson(const std::string& path, const ImageLimits& limits) {
  auto file = ImageFile::Open(path);
  if (absl::IsNotFound(file.status())) return std::nullopt;
  BCCSKEL_RETURN_IF_ERROR(file.status());
  BCCSKEL_ASSIGN_OR_RETURN(const ImageFront front, ReadFront(*std::move(file), limits));
  if (front.bytes.size() >= limits.max_header_bytes) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("'%s' has more than %d bytes", path, limits.max_header_bytes));
  }
  // Copies and messages would recurse as deep as the values are nested.
  bool too_deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, const Json&) {
    too_deep = too_deep || depth > kMostNested;
    return !too_deep;
  };
  Json json = Json::parse(front.bytes, keep, /*allow_exceptions=*/false);
  if (too_deep) {
    return absl::InvalidArgumentError(
        absl::StrFormat("'%s' has values nested more than %d deep", path, kMostNested));
  }
  if (json.is_object()) return json;
  return absl::InvalidArgumentError(absl::StrFormat("'%s' is not a JSON object", path));
}

const Json& MemberOf(const Json& object, std::string_view name) {
  static const Json kNone;
  if (!object.is_object()) return kNone;
  const auto member = object.find(std::string(name));
  return member == object.end() ? kNone : *member;
}

absl::StatusOr<int64_t> IntegerOf(std::string_view what, const Json& value) {
  const bool fits = value.is_number_unsigned()
                        ? value.get<uint64_t>() <= uint64_t{std::numeric_limits<int64_t>::max()}
                        : value.is_number_integer();
  if (!fits) return BadValue(what, value, "is not a whole number that fits");
  return value.get<int64_t>();
}

absl::StatusOr<double> NumberOf(std::string_view what, const Json& value) {
  if (!value.is_number()) return BadValue(what, value, "is not a number");
  return value.get<double>();
}

absl::StatusOr<std::string> TextOf(std::string_view what, const Json& value) {
  if (!value.is_string()) return BadValue(what, value, "is not a string");
  return value.get<std::string>();
}

absl::StatusOr<std::vector<int64_t>> IntegersOf(std::string_view what, const Json& value) {
  return ListOf<int64_t>(what, value, &IntegerOf);
}

absl::StatusOr<std::vector<double>> NumbersOf(std::string_view what, const Json& value) {
  return ListOf<double>(what, value, &NumberOf);
}

bool IsBelowFolder(std::string_view path) {
  const std::vector<std::string_view> parts = Words(path, "/");
  return !path.empty() && path.front() != '/' && path.find('\0') == path.npos &&
         std::ranges::find(parts, "..") == parts.end();
}

absl::Status BadValue(std::string_view what, const Json& value, std::string_view why) {
  if (value.is_string()) return BadField(what, value.get<std::string>(), why);
  // A string inside may hold what is not UTF-8.
  return BadField(what, value.dump(-1, ' ', true, Json::error_handler_t::replace), why);
}

}  // namespace bccskel
