#ifndef BCCSKEL_CORE_IMPORT_IMAGE_HEADER_TEXT_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_HEADER_TEXT_H_

#include <charconv>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel {

// How all headers that are text are taken apart.

// "what 'value' why": how all headers complain. The value is cut and escaped.
absl::Status BadField(std::string_view what, std::string_view value, std::string_view why);

// Without blanks, tabs and line ends on both sides.
std::string_view Trimmed(std::string_view text);
std::string LowerCase(std::string_view text);

// The whole text as a number, correctly rounded; nothing when it is not one or does not fit.
template <typename Number>
std::optional<Number> ParseNumber(std::string_view text) {
  text = Trimmed(text);
  Number value = {};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// The words between blanks, tabs and any of `separators`.
std::vector<std::string_view> Words(std::string_view text, std::string_view separators = "");

// The whole text as one number. Errors: as ParseNumbers().
template <typename Number>
absl::StatusOr<Number> RequireNumber(std::string_view what, std::string_view text) {
  const std::optional<Number> number = ParseNumber<Number>(text);
  if (number.has_value()) return *number;
  return BadField(what, text, "is not a number that fits");
}

// All words as numbers. Errors: INVALID_ARGUMENT, names `what` and the word that is none.
template <typename Number>
absl::StatusOr<std::vector<Number>> ParseNumbers(std::string_view what, std::string_view text) {
  std::vector<Number> numbers;
  for (const std::string_view word : Words(text)) {
    const std::optional<Number> number = ParseNumber<Number>(word);
    if (!number.has_value()) {
      return BadField(what, word, "is not a number that fits");
    }
    numbers.push_back(*number);
  }
  return numbers;
}

// Splits at the first of `separator`, both sides trimmed; nothing where there is none.
std::optional<std::pair<std::string_view, std::string_view>> SplitAt(std::string_view line,
                                                                     std::string_view separator);

// What a line of a header is.
enum class HeaderLine {
  kField,
  kIgnored,
  kLastField,  // a field, behind which the voxels begin
  kEnd,        // no field; behind it the voxels begin
};

// How a format writes its fields: a line each, "key SEPARATOR value".
struct HeaderSyntax {
  std::string_view separator;
  HeaderLine (*classify)(std::string_view line);
};

// The fields of a header, each key once. Views into the header's text.
class HeaderFields {
 public:
  // Lines end with LF or CR LF, the last one also with the text.
  // Errors: INVALID_ARGUMENT for a line without separator, and a key that is there twice.
  static absl::StatusOr<HeaderFields> Read(std::string_view text, const HeaderSyntax& syntax);

  // The value of the first of the keys that is there.
  std::optional<std::string_view> Find(std::initializer_list<std::string_view> keys) const;
  // Errors: INVALID_ARGUMENT, names the first key, where none is there.
  absl::StatusOr<std::string_view> Require(std::initializer_list<std::string_view> keys) const;
  // Where the voxels begin.
  // Errors: INVALID_ARGUMENT where the text ended before the header did.
  absl::StatusOr<size_t> Bytes() const;

 private:
  absl::Status Add(std::string_view line, std::string_view separator);

  std::map<std::string_view, std::string_view> fields_;
  std::optional<size_t> bytes_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_HEADER_TEXT_H_
