#include "core/import/mesh/data_array.h"

#include <array>
#include <optional>

#include "core/import/mesh/text_scanner.h"

namespace bccskel {

void DataArray::Append(double value) {
  const auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
  bytes_.append(raw.data(), raw.size());
}

absl::StatusOr<DataArray> DataArray::FromText(std::string_view format, std::string_view text) {
  TextScanner scanner(text, TextScanner::Comments::kNone, LineContinuation::kNone);
  DataArray array;
  for (std::string_view token = scanner.TokenAcrossLines(); !token.empty();
       token = scanner.TokenAcrossLines()) {
    const std::optional<double> value = ParseDouble(token);
    if (!value) return LineError(format, scanner, "expected a number", token);
    array.Append(*value);
  }
  return array;
}

}  // namespace bccskel
