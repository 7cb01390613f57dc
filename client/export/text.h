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
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text_.append(digits.data(), static_cast<size_t>(end - digits.data()));
  }

  std::string text_;
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_TEXT_H_
