#ifndef BCCSKEL_CLIENT_CLI_COMPLAINTS_H_
#define BCCSKEL_CLIENT_CLI_COMPLAINTS_H_

#include <CLI/CLI.hpp>
#include <string>

// What the parser says about a command line that is wrong.

namespace bccskel::cli {

struct Complaint {
  std::string what;
  std::string hint;  // empty: none
};

Complaint DescribeError(const CLI::App& app, const CLI::Error& error);

// The innermost one, as `core` of `bench core`.
const CLI::App& GivenCommand(const CLI::App& app);

// The error for an unknown command or option, or for a missing subcommand; empty: neither. CLI11
// would report a missing argument instead.
std::string UnknownWord(const CLI::App& app, const CLI::App& command);

// The error for a missing subcommand.
std::string CommandRequired(const CLI::App& app);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_COMPLAINTS_H_
