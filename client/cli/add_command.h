#ifndef BCCSKEL_CLIENT_CLI_ADD_COMMAND_H_
#define BCCSKEL_CLIENT_CLI_ADD_COMMAND_H_

#include <CLI/CLI.hpp>
#include <cstddef>

namespace bccskel::cli {

// Adds a command whose options are added when it is given: all commands have hundreds, which take
// as long as the skeleton of a small object. Option groups among them have a
// parse_complete_callback(): CLI11 calls callback() only of those that were there before.
// Needs: `arguments` outlives `app`.
template <typename Arguments>
CLI::App& AddCommand(CLI::App& app, const char* name, const char* description, Arguments& arguments,
                     void (*add_options)(CLI::App&, Arguments&)) {
  CLI::App* command = app.add_subcommand(name, description);
  command->preparse_callback([=, &arguments](size_t) { add_options(*command, arguments); });
  return *command;
}

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_ADD_COMMAND_H_
