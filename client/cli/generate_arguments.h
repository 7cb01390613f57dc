#ifndef BCCSKEL_CLIENT_CLI_GENERATE_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_GENERATE_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds `generate`, without the options that it shares with other commands.
CLI::App& AddGenerate(CLI::App& app, GenerateArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_GENERATE_ARGUMENTS_H_
