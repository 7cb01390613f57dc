#include "core/import/mesh/text_scanner.h"

#include <algorithm>
#include <charconv>

#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

constexpr char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

template <typename Number>
std::optional<Number> ParseWhole(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  Number value = {};
  const char* end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

}  // namespace

bool TextScanner::IsSpace(char c) const {
  return c == ' ' || (c >= '\t' && c <= '\r') ||
         (c == '\\' && continuation_ == LineContinuation::kBackslash);
}

// Joined lines keep their line ends and backslashes inside; both count as space.
std::string_view TextScanner::TakeLine() {
  line_number_ += lines_joined_;
  lines_joined_ = 1;
  size_t from = 0;
  while (true) {
    size_t end = from;
    while (end < rest_.size() && rest_[end] != '\n' && rest_[end] != '\r') ++end;
    size_t next = std::min(end + 1, rest_.size());
    if (end + 1 < rest_.size() && rest_[end] == '\r' && rest_[end + 1] == '\n') ++next;
    const bool joined = continuation_ == LineContinuation::kBackslash && end > from &&
                        rest_[end - 1] == '\\' && next < rest_.size();
    if (!joined) {
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(next);
      return line;
    }
    ++lines_joined_;
    from = next;
  }
}

bool TextScanner::NextLine() {
  while (!rest_.empty()) {
    line_ = TakeLine();
    if (comments_ == Comments::kHash) line_ = line_.substr(0, line_.find('#'));
    const auto token = std::ranges::find_if(line_, [this](char c) { return !IsSpace(c); });
    line_.remove_prefix(static_cast<size_t>(token - line_.begin()));
    if (!line_.empty()) return true;
  }
  line_ = {};
  return false;
}

std::string_view TextScanner::Token() {
  size_t begin = 0;
  while (begin < line_.size() && IsSpace(line_[begin])) ++begin;
  size_t end = begin;
  while (end < line_.size() && !IsSpace(line_[end])) ++end;
  const std::string_view token = line_.substr(begin, end - begin);
  line_.remove_prefix(end);
  return token;
}

std::string_view TextScanner::TokenAcrossLines() {
  std::string_view token = Token();
  while (token.empty() && NextLine()) token = Token();
  return token;
}

std::optional<double> ParseDouble(std::string_view token) { return ParseWhole<double>(token); }
std::optional<int64_t> ParseInteger(std::string_view token) { return ParseWhole<int64_t>(token); }

absl::Status LineError(std::string_view format, const TextScanner& text, std::string_view what,
                       std::string_view token) {
  return absl::InvalidArgumentError(absl::StrFormat("%s line %d: %s, found '%s'", format,
                                                    text.line_number(), what, token.substr(0, 40)));
}

absl::Status CheckMarks(std::string_view format, std::string_view text,
                        std::string_view characters) {
  const auto marks =
      std::ranges::count_if(text, [&](char c) { return characters.find(c) != characters.npos; });
  if (static_cast<uint64_t>(marks) <= kMaxMarks) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      absl::StrFormat("%s: %d of the characters %s mark parts of the file; the limit is %d", format,
                      marks, characters, kMaxMarks));
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return Lower(x) == Lower(y); });
}

}  // namespace bccskel
