#ifndef BCCSKEL_CLIENT_CLI_COMPLAINTS_H_
#define BCCSKEL_CLIENT_CLI_COMPLAINTS_H_

#include <optional>
#include <string>

#include "client/cli/arguments.h"

namespace bccskel::cli {

// What is wrong with arguments that are right one by one; nothing where they fit together.
std::optional<std::string> ComplaintAbout(const Arguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_COMPLAINTS_H_
