#ifndef BCCSKEL_CLIENT_EXPORT_TEXT_H_
#define BCCSKEL_CLIENT_EXPORT_TEXT_H_

#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace bccskel::exporting {

// Builds a text file. Numbers are written in the shortest form that reads back to the same value,
// whatever the locale, so equal skeletons give equal bytes.
class Text {
 public:
  template <typename... Parts>
  Text& Add(const Parts&... parts) {
    (Append(parts), ...);
    return *this;
  }
  // With at most this many decimals, and no zeros at their end.
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
  std::string Take() && { return std::move(text_); }

 private:
  void Append(std::string_view part) { text_.append(part); }
  void Append(char part) { text_.push_back(part); }
  template <typename Number>
  requires(std::integral<Number> || std::floating_point<Number>) void Append(Number number) {
    std::array<char, 32> digits;
    char* end = nullptr;
    if constexpr (std::floating_point<Number>) end = WriteHalf(number, digits.data());
    if (end == nullptr) {
      end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    }
    text_.append(digits.data(), static_cast<size_t>(end - digits.data()));
  }
  // What std::to_chars() writes in ten times the time, of whole numbers and halves, as which most
  // coordinates come. Null for other numbers.
  static char* WriteHalf(double number, char* to) {
    constexpr double kLargest = 9999;  // exponents are as short for larger ones
    const double size = number < 0 ? -number : number;
    if (!(size > 0 && size <= kLargest)) return nullptr;
    const auto halves = static_cast<int>(2 * size);
    if (halves != 2 * size) return nullptr;
    if (number < 0) *to++ = '-';
    to = std::to_chars(to, to + 4, halves / 2).ptr;
    if (halves % 2 != 0) {
      *to++ = '.';
      *to++ = '5';
    }
    return to;
  }

  std::string text_;
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_TEXT_H_
