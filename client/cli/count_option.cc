#include "client/cli/count_option.h"

#include <algorithm>

namespace bccskel::cli {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Takes the digits in front of the text and appends them to `digits`.
void TakeDigits(std::string_view& text, std::string& digits) {
  const auto end = std::ranges::find_if_not(text, IsDigit);
  const auto count = static_cast<size_t>(end - text.begin());
  digits += text.substr(0, count);
  text.remove_prefix(count);
}

// Takes "k", "M", "G" or "e6": how many zeros it stands for.
std::optional<int> TakeZeros(std::string_view& text) {
  if (text.empty()) return 0;
  const char letter = text.front();
  text.remove_prefix(1);
  if (letter == 'k' || letter == 'K') return 3;
  if (letter == 'M') return 6;
  if (letter == 'G') return 9;
  if (letter != 'e' && letter != 'E') return std::nullopt;
  if (text.starts_with('+')) text.remove_prefix(1);
  std::string exponent;
  TakeDigits(text, exponent);
  if (exponent.empty() || exponent.size() > 2) return std::nullopt;
  return std::stoi(exponent);
}

}  // namespace

std::optional<uint64_t> ParseCount(std::string_view text) {
  std::string digits, decimals;
  TakeDigits(text, digits);
  if (digits.empty()) return std::nullopt;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    TakeDigits(text, decimals);
    if (decimals.empty()) return std::nullopt;
  }
  const std::optional<int> zeros = TakeZeros(text);
  if (!zeros.has_value() || !text.empty()) return std::nullopt;
  decimals.resize(std::max(decimals.size(), static_cast<size_t>(*zeros)), '0');
  const auto fraction = std::string_view(decimals).substr(static_cast<size_t>(*zeros));
  if (fraction.find_first_not_of('0') != fraction.npos) return std::nullopt;
  uint64_t count = 0;
  for (const char digit : digits + decimals.substr(0, static_cast<size_t>(*zeros))) {
    const bool fits = !__builtin_mul_overflow(count, uint64_t{10}, &count) &&
                      !__builtin_add_overflow(count, static_cast<uint64_t>(digit - '0'), &count);
    if (!fits) return std::nullopt;
  }
  return count;
}

}  // namespace bccskel::cli
