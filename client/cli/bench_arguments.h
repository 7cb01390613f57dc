#ifndef BCCSKEL_CLIENT_CLI_BENCH_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_BENCH_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds `bench core` to the command line and returns `bench`.
CLI::App& AddBench(CLI::App& app, BenchCoreArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_BENCH_ARGUMENTS_H_
