#ifndef BCCSKEL_CLIENT_CLI_JSON_TEXT_H_
#define BCCSKEL_CLIENT_CLI_JSON_TEXT_H_

#include <string>
#include <string_view>

namespace bccskel::cli {

// The text as a JSON string with its quotes. Bytes that are not UTF-8, as file names may hold,
// become U+FFFD.
std::string JsonString(std::string_view text);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_JSON_TEXT_H_
