#ifndef BCCSKEL_CLIENT_CLI_RESULT_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_RESULT_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Add the options of commands that read a result, without those that they share with commands of
// other kinds (grid, threads, summary).
void AddView(CLI::App& command, ViewArguments& arguments);
void AddRender(CLI::App& command, RenderArguments& arguments);
void AddConvert(CLI::App& command, ConvertArguments& arguments);
void AddReconstruct(CLI::App& command, ReconstructArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_RESULT_ARGUMENTS_H_
