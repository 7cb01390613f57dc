#ifndef BCCSKEL_CLIENT_CLI_RESULT_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_RESULT_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Add a command that reads a result, without the options that it shares with commands of other
// kinds (grid, threads, summary).
CLI::App& AddView(CLI::App& app, ViewArguments& arguments);
CLI::App& AddRender(CLI::App& app, RenderArguments& arguments);
CLI::App& AddConvert(CLI::App& app, ConvertArguments& arguments);
CLI::App& AddReconstruct(CLI::App& app, ReconstructArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_RESULT_ARGUMENTS_H_
