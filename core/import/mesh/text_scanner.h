#ifndef BCCSKEL_CORE_IMPORT_MESH_TEXT_SCANNER_H_
#define BCCSKEL_CORE_IMPORT_MESH_TEXT_SCANNER_H_

#include <cstdint>
#include <optional>
#include <string_view>

#include "absl/status/status.h"

namespace bccskel {

// Does a backslash at the end of a line join it with the next one (OBJ)?
enum class LineContinuation { kNone, kBackslash };

// Splits text into lines and lines into tokens, in one pass over the bytes and without copies.
// Lines end with LF, CR or CR LF; '#' starts a comment where the format has them.
class TextScanner {
 public:
  enum class Comments { kNone, kHash };

  TextScanner(std::string_view text, Comments comments, LineContinuation continuation)
      : rest_(text), comments_(comments), continuation_(continuation) {}

  // Goes to the next line that has a token; false at the end of the text.
  bool NextLine();
  // The next token of this line; empty when the line has no more.
  std::string_view Token();
  // The next token of this line or of a later one; empty at the end of the text.
  std::string_view TokenAcrossLines();
  // Skips the rest of this line.
  void SkipLine() { line_ = {}; }

  uint64_t line_number() const { return line_number_; }  // from 1

 private:
  std::string_view TakeLine();
  bool IsSpace(char c) const;

  std::string_view rest_;
  std::string_view line_;
  Comments comments_;
  LineContinuation continuation_;
  uint64_t line_number_ = 0;
  uint64_t lines_joined_ = 1;
};

// The whole token as a number, correctly rounded; nothing when it is not one or does not fit.
// "nan" and "inf" are numbers here: callers that need finite values check, and can name the place.
std::optional<double> ParseDouble(std::string_view token);
std::optional<int64_t> ParseInteger(std::string_view token);

// INVALID_ARGUMENT: "OFF line 7: expected a coordinate, found 'x'".
absl::Status LineError(std::string_view format, const TextScanner& text, std::string_view what,
                       std::string_view token);

// Meshes have few elements and long texts. More than this many marks (tags, attributes; braces and
// commas of JSON) would take many times the memory of the file.
constexpr uint64_t kMaxMarks = uint64_t{1} << 21;

// Errors: RESOURCE_EXHAUSTED if `text` has more than kMaxMarks of the characters.
absl::Status CheckMarks(std::string_view format, std::string_view text,
                        std::string_view characters);

bool EqualsIgnoringCase(std::string_view a, std::string_view b);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_TEXT_SCANNER_H_
