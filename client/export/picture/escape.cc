#include "client/export/picture/escape.h"

#include <cstddef>
#include <cstdint>

namespace bccskel::exporting {
namespace {

// Length of the UTF-8 sequence at the front, 0 if there is none (RFC 3629).
size_t Utf8Length(std::string_view text) {
  const auto byte = [&](size_t n) { return static_cast<uint8_t>(text[n]); };
  const uint8_t first = byte(0);
  const size_t length = first < 0x80   ? 1
                        : first < 0xc2 ? 0
                        : first < 0xe0 ? 2
                        : first < 0xf0 ? 3
                                       : 4;
  if (length == 0 || first > 0xf4 || length > text.size()) return 0;
  for (size_t n = 1; n < length; ++n) {
    if ((byte(n) & 0xc0) != 0x80) return 0;
  }
  if (length == 1) return 1;
  const uint8_t second = byte(1);
  const bool too_long = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool no_character = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  return too_long || no_character ? 0 : length;
}

bool IsControl(char c) { return static_cast<uint8_t>(c) < 0x20; }

// Writes `invalid` for each byte that is not UTF-8, and `write(c)` for each one-byte character.
template <typename Write>
std::string Rewritten(std::string_view text, std::string_view invalid, Write write) {
  std::string written;
  while (!text.empty()) {
    const size_t length = Utf8Length(text);
    if (length == 0) {
      written += invalid;
    } else if (length == 1) {
      written += write(text.front());
    } else {
      written += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return written;
}

constexpr std::string_view kReplacement = "\xef\xbf\xbd";

std::string InJson(char c) {
  constexpr std::string_view kHex = "0123456789abcdef";
  const auto byte = static_cast<uint8_t>(c);
  if (IsControl(c)) return {'\\', 'u', '0', '0', kHex[byte >> 4], kHex[byte & 15]};
  if (c == '"' || c == '\\') return {'\\', c};
  return {c};
}

std::string InMarkup(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    default:
      return {IsControl(c) ? ' ' : c};
  }
}

}  // namespace

std::string JsonString(std::string_view text) {
  return '"' + Rewritten(text, "\\ufffd", InJson) + '"';
}

std::string EscapeMarkup(std::string_view text) { return Rewritten(text, kReplacement, InMarkup); }

std::string OnOneLine(std::string_view text) {
  return Rewritten(text, kReplacement, [](char c) { return IsControl(c) ? ' ' : c; });
}

}  // namespace bccskel::exporting
