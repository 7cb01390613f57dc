#ifndef BCCSKEL_CLIENT_EXPORT_TEXT_H_
#define BCCSKEL_CLIENT_EXPORT_TEXT_H_

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
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
    if constexpr (std::floating_point<Number>) {
      end = WriteBinary(number, std::numeric_limits<Number>::digits10, begin);
    }
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
  // Writes the same as std::to_chars() in a fraction of the time, for numbers with few binary
  // places, such as most coordinates of masks. With n of them they have n decimals, and no shorter
  // form if all digits are at most as many as the type always keeps. Null for other numbers.
  static char* WriteBinary(double number, int most_digits, char* to) {
    constexpr int kPlaces = 12;
    constexpr double kLeast = 0.125, kLargest = 9999;  // exponents are as short for others
    const double size = number < 0 ? -number : number;
    if (!(size >= kLeast && size <= kLargest)) return nullptr;
    const auto parts = static_cast<uint32_t>(size * (1 << kPlaces));
    if (parts != size * (1 << kPlaces)) return nullptr;
    const int places = std::max(kPlaces - std::countr_zero(parts), 0);
    const uint32_t whole = parts >> kPlaces;
    const int whole_digits = 1 + (whole >= 10) + (whole >= 100) + (whole >= 1000);
    if (whole_digits + places > most_digits) return nullptr;
    if (number < 0) *to++ = '-';
    to = WriteDigits(whole, whole_digits, to);
    if (places == 0) return to;
    *to++ = '.';
    uint64_t decimals = (parts % (1 << kPlaces)) >> (kPlaces - places);
    for (int n = 0; n < places; ++n) decimals *= 5;
    return WriteDigits(decimals, places, to);
  }
  static char* WriteDigits(uint64_t number, int count, char* to) {
    for (char* digit = to + count; digit-- > to; number /= 10) {
      *digit = static_cast<char>('0' + number % 10);
    }
    return to + count;
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
