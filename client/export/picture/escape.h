#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_ESCAPE_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_ESCAPE_H_

#include <string>
#include <string_view>

namespace bccskel::exporting {

// Escape texts of users and files for use in other texts. Bytes that are not UTF-8, as in file
// names and units, become U+FFFD.

// A JSON string with its quotes.
std::string JsonString(std::string_view text);

// Text or the value of an attribute in XML and HTML; control characters become spaces.
std::string EscapeMarkup(std::string_view text);

// A part of a line: control characters become spaces.
std::string OnOneLine(std::string_view text);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_ESCAPE_H_
