#include "server/settings/values.h"

#include <array>
#include <limits>
#include <string_view>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "proto/address/address.h"

namespace bccskel::server {
namespace {

absl::Status Wrong(const std::string& text, const std::string& must) {
  return absl::InvalidArgumentError(absl::StrCat(text, ": must be ", must));
}

// The power of 1024 of a unit; -1 for an unknown unit.
int PowerOf(std::string unit) {
  absl::AsciiStrToLower(&unit);
  if (unit.empty() || unit == "b") return 0;
  constexpr std::string_view kLetters = "kmgt";
  const size_t power = kLetters.find(unit[0]);
  const std::string rest = unit.substr(1);
  const bool known =
      power != std::string_view::npos && (rest.empty() || rest == "b" || rest == "ib");
  return known ? static_cast<int>(power) + 1 : -1;
}

}  // namespace

absl::StatusOr<int> ParseNumber(const std::string& text, int low, int high) {
  int number = 0;
  if (absl::SimpleAtoi(text, &number) && number >= low && number <= high) return number;
  return Wrong(text, absl::StrCat("a number from ", low, " to ", high));
}

absl::StatusOr<uint64_t> ParseSize(const std::string& text, uint64_t low) {
  const size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  std::string unit = text.substr(digits);
  absl::StripAsciiWhitespace(&unit);
  uint64_t bytes = 0;
  const int power = PowerOf(unit);
  const bool number = absl::SimpleAtoi(text.substr(0, digits), &bytes) && power >= 0;
  if (number && bytes <= std::numeric_limits<uint64_t>::max() >> (10 * power)) {
    bytes <<= 10 * power;
    if (bytes >= low) return bytes;
  }
  return Wrong(text, absl::StrCat("a size of at least ", low,
                                  " bytes, with or without a unit, such as 256MB or 8GB"));
}

std::string SocketPathOf(const std::string& address) {
  if (!absl::StartsWith(address, kUnixPrefix)) return std::string();
  const std::string path = address.substr(sizeof(kUnixPrefix) - 1);
  return absl::StartsWith(path, "//") ? path.substr(2) : path;
}

}  // namespace bccskel::server
