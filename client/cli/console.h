#ifndef BCCSKEL_CLIENT_CLI_CONSOLE_H_
#define BCCSKEL_CLIENT_CLI_CONSOLE_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "client/cli/exit_code.h"
#include "client/cli/server_arguments.h"

namespace bccskel::cli {

// What a command says. Results go to standard output, everything else to standard error.

void Warn(std::string_view message);
void Note(std::string_view message);

// Prints the error, with a hint where there is one, and returns the exit code for it.
ExitCode Fail(const absl::Status& error, std::string_view hint = "");
ExitCode FailWith(ExitCode code, const absl::Status& error);

// For what went wrong between the user and a server, which it names. A hint of its own says what
// else may be wrong with the connection.
ExitCode FailOnServer(const ServerArguments& server, const absl::Status& error,
                      std::string_view hint = "");

// Prints a command's result. kOutput when standard output takes no more.
ExitCode Print(std::string_view text);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_CONSOLE_H_
