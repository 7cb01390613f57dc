#ifndef BCCSKEL_CLIENT_EXPORT_TEXT_H_
#define BCCSKEL_CLIENT_EXPORT_TEXT_H_

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

namespace bccskel::exporting {

// Builds a text file. Numbers are written in the shortest form that reads back to the same value,
// whatever the locale, so equal skeletons give equal bytes. Values that are not there are "null".
class Text {
 public:
  // Once `stop` is requested, loops over large data end early: the text is then incomplete and must
  // not be used.
  explicit Text(std::stop_token stop = {}) : stop_(std::move(stop)) {}
  bool stopped() const { return stop_.stop_requested(); }

  template <typename... Parts>
  Text& Add(const Parts&... parts) {
    (Append(parts), ...);
    return *this;
  }
  // With at most this many decimals, without trailing zeros.
  Text& AddRounded(double number, int decimals) {
    std::array<char, 400> digits;  // the largest double has 309 in front of the point
    char* end = std::to_chars(digits.data(), digits.data() + digits.size(), number,
                              std::chars_format::fixed, decimals)
                    .ptr;
    if (decimals > 0) {
      while (end[-1] == '0') --end;
      if (end[-1] == '.') --end;
    }
    const std::string_view text(digits.data(), static_cast<size_t>(end - digits.data()));
    Append(text == "-0" ? "0" : text);
    return *this;
  }
  size_t size() const { return used_; }
  // For a text of about this size: saves copying it as it grows.
  void Reserve(size_t bytes) { text_.reserve(bytes); }
  std::string Take() && {
    text_.resize(used_);
    return std::move(text_);
  }

 private:
  static constexpr size_t kMostDigits = 32;  // of a number

  void Append(std::string_view part) {
    std::ranges::copy(part, Room(part.size()));
    used_ += part.size();
  }
  void Append(char part) {
    *Room(1) = part;
    ++used_;
  }
  template <typename Number>
  requires(std::integral<Number> || std::floating_point<Number>) void Append(Number number) {
    char* const begin = Room(kMostDigits);
    char* end = nullptr;
    if constexpr (std::floating_point<Number>) end = WriteHalf(number, begin);
    if (end == nullptr) end = std::to_chars(begin, begin + kMostDigits, number).ptr;
    used_ += static_cast<size_t>(end - begin);
  }
  template <typename Value>
  void Append(const std::optional<Value>& value) {
    value.has_value() ? Append(*value) : Append(std::string_view("null"));
  }
  // Space for at most `bytes` more bytes. Most calls do not grow the string, and those that do
  // clear no more than a cache holds.
  char* Room(size_t bytes) {
    constexpr size_t kMostAhead = size_t{1} << 16;
    if (text_.size() - used_ < bytes) {
      text_.resize(used_ + bytes + std::min(used_ / 8, kMostAhead));
    }
    return text_.data() + used_;
  }
  // Writes the same as std::to_chars() in a tenth of the time, for whole numbers and halves, which
  // most coordinates are. Null for other numbers.
  static char* WriteHalf(double number, char* to) {
    constexpr double kLargest = 9999;  // exponents are as short for larger ones
    const double size = number < 0 ? -number : number;
    if (!(size > 0 && size <= kLargest)) return nullptr;
    const auto halves = static_cast<int>(2 * size);
    if (halves != 2 * size) return nullptr;
    if (number < 0) *to++ = '-';
    const int whole = halves / 2;
    for (const int tens : {1000, 100, 10}) {
      if (whole >= tens) *to++ = static_cast<char>('0' + whole / tens % 10);
    }
    *to++ = static_cast<char>('0' + whole % 10);
    if (halves % 2 != 0) {
      *to++ = '.';
      *to++ = '5';
    }
    return to;
  }

  std::stop_token stop_;
  std::string text_;  // larger than its used part
  size_t used_ = 0;
};

// A file, and what its format could not hold, as a sentence for the user; empty if it held
// everything.
struct Document {
  std::string text;
  std::string note;
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_TEXT_H_
