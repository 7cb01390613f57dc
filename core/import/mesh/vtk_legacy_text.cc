#include "core/import/mesh/vtk_legacy_text.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

// VTK writes vtkIdType with 32 bits, long with the 64 of the machines that write files today.
constexpr std::array<std::pair<std::string_view, Scalar>, 14> kVtkTypes = {{
    {"char", Scalar::kInt8},
    {"signed_char", Scalar::kInt8},
    {"unsigned_char", Scalar::kUint8},
    {"short", Scalar::kInt16},
    {"unsigned_short", Scalar::kUint16},
    {"int", Scalar::kInt32},
    {"unsigned_int", Scalar::kUint32},
    {"vtkidtype", Scalar::kInt32},
    {"long", Scalar::kInt64},
    {"vtktypeint64", Scalar::kInt64},
    {"unsigned_long", Scalar::kUint64},
    {"vtktypeuint64", Scalar::kUint64},
    {"float", Scalar::kFloat32},
    {"double", Scalar::kFloat64},
}};

std::optional<Scalar> VtkTypeOf(std::string_view name) {
  for (const auto& [known, type] : kVtkTypes) {
    if (EqualsIgnoringCase(known, name)) return type;
  }
  return std::nullopt;
}

bool IsBlank(char c) { return absl::ascii_isspace(static_cast<unsigned char>(c)); }

}  // namespace

std::string_view VtkLegacyText::Word() {
  const auto begin = std::ranges::find_if_not(rest_, &IsBlank);
  const auto end = std::find_if(begin, rest_.end(), &IsBlank);
  rest_.remove_prefix(static_cast<size_t>(begin - rest_.begin()));
  const std::string_view word = rest_.substr(0, static_cast<size_t>(end - begin));
  rest_.remove_prefix(word.size());
  return word;
}

std::string_view VtkLegacyText::Line() {
  const size_t end = std::min(rest_.find('\n'), rest_.size());
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

absl::StatusOr<uint64_t> VtkLegacyText::Count(std::string_view word) const {
  const std::optional<int64_t> count = ParseInteger(word);
  if (!count || *count < 0) return Error("a count of 0 or more", word);
  return static_cast<uint64_t>(*count);
}

absl::StatusOr<DataArray> VtkLegacyText::Values(uint64_t count, std::string_view type) {
  const std::optional<Scalar> scalar = VtkTypeOf(type);
  if (!scalar) return Error("a type of numbers such as float or vtktypeint64", type);
  if (numbers_ == Numbers::kBigEndian) Line();
  const uint64_t size = numbers_ == Numbers::kText ? 1 : ScalarBytes(*scalar);
  if (count > rest_.size() / size) {
    return absl::InvalidArgumentError(
        absl::StrFormat("VTK file declares %d numbers of type %s; %d bytes follow: is it cut?",
                        count, type, rest_.size()));
  }
  if (numbers_ == Numbers::kBigEndian) {
    DataArray array(std::string(rest_.substr(0, count * size)), *scalar, std::endian::big);
    rest_.remove_prefix(count * size);
    return array;
  }
  DataArray array;
  for (uint64_t n = 0; n < count; ++n) {
    const std::string_view word = Word();
    const std::optional<double> value = ParseDouble(word);
    if (!value) return Error("a number", word);
    array.Append(*value);
  }
  return array;
}

// Counts the lines only here: binary data has line ends that are none.
absl::Status VtkLegacyText::Error(std::string_view expected, std::string_view found) const {
  const std::string_view read = all_.substr(0, all_.size() - rest_.size());
  std::string shown;
  for (const char c : found.substr(0, 40)) {
    shown.push_back(absl::ascii_isprint(static_cast<unsigned char>(c)) ? c : '?');
  }
  return absl::InvalidArgumentError(absl::StrFormat(
      "VTK line %d: expected %s, found '%s'", 1 + std::ranges::count(read, '\n'), expected, shown));
}

}  // namespace bccskel
