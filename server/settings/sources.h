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

// The sources of settings: the command line overrides the environment, which overrides the file.

namespace bccskel::server {

// Values by the name of their setting; a name that the source does not give is absent.
using GivenValues = std::map<std::string, std::vector<std::string>>;

// The output and exit code of a program that ends here.
struct ExitRequest {
  int code = 0;
  std::string out;  // for standard output
  std::string err;  // for standard error
};

struct CommandLine {
  GivenValues values;
  std::map<std::string, std::string> actions;  // by name, with their arguments
};

// An option of the command line that is not a setting: --check-config, --new-token TENANT.
struct Action {
  std::string name;
  std::string argument;  // its placeholder in the help; empty: no argument
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

// The variable for max-jobs is BCCSKEL_MAX_JOBS; commas separate several addresses. An empty
// variable counts as absent.
std::string VariableOf(const std::string& setting);
GivenValues ReadEnvironment(const std::vector<Setting>& settings,
                            const std::function<const char*(const char*)>& variable);

// Reads lines such as `max-jobs = 4`: TOML. A section, which no setting is in, is given by its name
// in brackets.
// Errors: NOT_FOUND if the file cannot be read; INVALID_ARGUMENT for any other line.
absl::StatusOr<GivenValues> ReadConfigFile(const std::string& path);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SETTINGS_SOURCES_H_
