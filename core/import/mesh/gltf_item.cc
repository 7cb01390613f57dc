#include "core/import/mesh/gltf_item.h"

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

constexpr uint64_t kMostWhole = uint64_t{1} << 40;  // sums and products of two fit 128 bits

// For errors. What holds others is not written: it may be as deep as the file is long.
std::string ShownValue(const Json& value) {
  if (value.is_structured()) return value.is_array() ? "a list" : "an object";
  return value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 40);
}

absl::StatusOr<uint64_t> WholeOf(const GltfItem& item, std::string_view key, const Json& value) {
  if (value.is_number_unsigned() && value.get<uint64_t>() <= kMostWhole) {
    return value.get<uint64_t>();
  }
  return item.Error(absl::StrFormat("%s must be a whole number of 0 to %d, is %s", key, kMostWhole,
                                    ShownValue(value)));
}

}  // namespace

const Json& GltfMember(const Json& object, std::string_view key) {
  static const Json kNone;
  if (!object.is_object()) return kNone;
  const auto member = object.find(key);
  return member == object.end() ? kNone : *member;
}

absl::StatusOr<GltfItem> GltfItem::At(const Json& document, const char* list, uint64_t index) {
  const Json& items = GltfMember(document, list);
  const std::string name = absl::StrFormat("%s[%d]", list, index);
  const size_t count = items.is_array() ? items.size() : 0;
  if (index < count && items[index].is_object()) return GltfItem(items[index], name);
  return absl::InvalidArgumentError(absl::StrFormat(
      "glTF names %s, which is not there or no object; '%s' has %d entries", name, list, count));
}

GltfItem GltfItem::Inside(std::string_view key) const {
  return GltfItem((*this)[key], absl::StrFormat("%s.%s", name_, key));
}

absl::StatusOr<uint64_t> GltfItem::Whole(std::string_view key) const {
  return WholeOf(*this, key, (*this)[key]);
}

absl::StatusOr<uint64_t> GltfItem::WholeOr(std::string_view key, uint64_t otherwise) const {
  if (!Has(key)) return otherwise;
  return Whole(key);
}

absl::StatusOr<std::vector<uint64_t>> GltfItem::Wholes(std::string_view key) const {
  std::vector<uint64_t> numbers;
  const Json& list = (*this)[key];
  if (list.is_null()) return numbers;
  if (!list.is_array()) return Error(absl::StrFormat("%s must be a list", key));
  for (const Json& value : list) {
    BCCSKEL_ASSIGN_OR_RETURN(numbers.emplace_back(), WholeOf(*this, key, value));
  }
  return numbers;
}

absl::StatusOr<std::vector<double>> GltfItem::Numbers(std::string_view key, size_t count) const {
  std::vector<double> numbers;
  const Json& list = (*this)[key];
  if (list.is_array() && list.size() == count) {
    for (const Json& value : list) {
      if (value.is_number()) numbers.push_back(value.get<double>());
    }
  }
  if (numbers.size() == count) return numbers;
  return Error(absl::StrFormat("%s must be a list of %d numbers", key, count));
}

std::string_view GltfItem::Text(std::string_view key) const {
  const Json& value = (*this)[key];
  return value.is_string() ? std::string_view(value.get_ref<const std::string&>())
                           : std::string_view();
}

absl::Status GltfItem::Error(std::string_view what) const {
  return absl::InvalidArgumentError(absl::StrFormat("glTF %s: %s", name_, what));
}

}  // namespace bccskel
