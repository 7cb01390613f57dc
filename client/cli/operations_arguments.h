#ifndef BCCSKEL_CLIENT_CLI_OPERATIONS_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_OPERATIONS_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Add the options of the commands for those who run a server.
void AddProbe(CLI::App& command, ProbeArguments& arguments);
void AddTop(CLI::App& command, TopArguments& arguments);
void AddBenchServer(CLI::App& command, BenchServerArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_OPERATIONS_ARGUMENTS_H_
