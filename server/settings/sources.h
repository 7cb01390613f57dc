#ifndef BCCSKEL_SERVER_SETTINGS_SOURCES_H_
#define BCCSKEL_SERVER_SETTINGS_SOURCES_H_

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "server/settings/setting.h"

// Where settings come from: the command line beats the environment, which beats the file.

namespace bccskel::server {

// Values by the name of their setting; a name is absent where the source does not give it.
using GivenValues = std::map<std::string, std::vector<std::string>>;

// What a program says where nothing is left to do, and its exit code.
struct ExitRequest {
  int code = 0;
  std::string out;  // for standard output
  std::string err;  // for standard error
};

struct CommandLine {
  GivenValues values;
  std::map<std::string, std::string> actions;  // what else was asked for, with its argument
};

// A word of the command line that is no setting: --check-config, --new-token TENANT.
struct Action {
  std::string name;
  std::string argument;  // what stands for it in the help; empty: it takes none
  std::string description;
};

// `about`: the program's name, version and purpose.
struct Program {
  std::string name;
  std::string version;
  std::string purpose;
};

// Errors, --help and --version are exit requests; errors have code 2.
std::variant<CommandLine, ExitRequest> ReadCommandLine(const Program& program,
                                                       const std::vector<Setting>& settings,
                                                       const std::vector<Action>& actions, int argc,
                                                       const char* const* argv);

// The variable of max-jobs is BCCSKEL_MAX_JOBS; several addresses are separated by commas. A
// variable that is empty is not given.
std::string VariableOf(const std::string& setting);
GivenValues ReadEnvironment(const std::vector<Setting>& settings,
                            const std::function<const char*(const char*)>& variable);

// Lines like `max-jobs = 4` in TOML without sections.
// Errors: NOT_FOUND where the file cannot be read; INVALID_ARGUMENT for what is no such line.
absl::StatusOr<GivenValues> ReadConfigFile(const std::string& path);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SETTINGS_SOURCES_H_
