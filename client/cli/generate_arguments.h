#ifndef BCCSKEL_CLIENT_CLI_GENERATE_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_GENERATE_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options of `generate`, without those that it shares with other commands.
void AddGenerate(CLI::App& command, GenerateArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_GENERATE_ARGUMENTS_H_
