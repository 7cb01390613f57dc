#ifndef BCCSKEL_CLIENT_CLI_OPERATIONS_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_OPERATIONS_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Add the commands for those who run a server.
CLI::App& AddProbe(CLI::App& app, ProbeArguments& arguments);
CLI::App& AddTop(CLI::App& app, TopArguments& arguments);
// Adds `server` to `bench`.
CLI::App& AddBenchServer(CLI::App& bench, BenchServerArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_OPERATIONS_ARGUMENTS_H_
