#include "server/settings/sources.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"

namespace bccskel::server {
namespace {

constexpr int kUsageError = 2;

std::string WithDefault(const Setting& setting) {
  std::string shown = absl::StrReplaceAll(setting.show(), {{"[", ""}, {"]", ""}, {"\"", ""}});
  return setting.description + (shown.empty() ? "" : " (default " + shown + ")");
}

void AddSetting(CLI::App& app, const Setting& setting, CommandLine& line) {
  app.add_option_function<std::vector<std::string>>(
         "--" + setting.name,
         [&line, name = setting.name](const std::vector<std::string>& values) {
           line.values[name] = values;
         },
         WithDefault(setting))
      ->allow_extra_args(false)
      ->option_text(setting.value);
}

void AddAction(CLI::App& app, const Action& action, CommandLine& line) {
  const std::string flag = "--" + action.name;
  if (action.argument.empty()) {
    app.add_flag_callback(
        flag, [&line, name = action.name] { line.actions[name] = ""; }, action.description);
    return;
  }
  app.add_option_function<std::string>(
         flag,
         [&line, name = action.name](const std::string& value) { line.actions[name] = value; },
         action.description)
      ->option_text(action.argument);
}

// Rewords the errors of CLI11.
std::string InWords(const CLI::App& app, const CLI::ParseError& error) {
  std::string what = error.what();
  const std::vector<std::string> rest = app.remaining();
  const auto is = [&error](CLI::ExitCodes code) {
    return error.get_exit_code() == static_cast<int>(code);
  };
  if (is(CLI::ExitCodes::ExtrasError) && !rest.empty()) {
    return "there is no setting " + rest.front();
  }
  const std::string name = what.substr(0, what.find(':'));
  const CLI::Option* const option = app.get_option_no_throw(name);
  if (!is(CLI::ExitCodes::ArgumentMismatch) || option == nullptr) return what;
  return absl::StrCat(name, ": needs a value: ", name, " ", option->get_option_text());
}

}  // namespace

std::variant<CommandLine, ExitRequest> ReadCommandLine(const Program& program,
                                                       const std::vector<Setting>& settings,
                                                       const std::vector<Action>& actions, int argc,
                                                       const char* const* argv) {
  CommandLine line;
  CLI::App app(program.purpose, program.name);
  app.set_version_flag("--version", program.name + " " + program.version);
  for (const Setting& setting : settings) AddSetting(app, setting, line);
  for (const Action& action : actions) AddAction(app, action, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int code = app.exit(error, out, err);
    if (code == 0) return ExitRequest{0, out.str(), ""};
    return ExitRequest{kUsageError, "",
                       absl::StrCat(program.name, ": ", InWords(app, error), "\n", program.name,
                                    ": see --help\n")};
  }
  return line;
}

std::string VariableOf(const std::string& setting) {
  return "BCCSKEL_" + absl::AsciiStrToUpper(absl::StrReplaceAll(setting, {{"-", "_"}}));
}

GivenValues ReadEnvironment(const std::vector<Setting>& settings,
                            const std::function<const char*(const char*)>& variable) {
  GivenValues given;
  for (const Setting& setting : settings) {
    const char* const value = variable(VariableOf(setting.name).c_str());
    if (value == nullptr || *value == '\0') continue;
    given[setting.name] = setting.values == Setting::Values::kList
                              ? absl::StrSplit(value, ',')
                              : std::vector<std::string>{value};
  }
  return given;
}

absl::StatusOr<GivenValues> ReadConfigFile(const std::string& path) {
  std::ifstream file(path);
  file.peek();  // fails for a folder, which can be opened
  if (!file.is_open() || file.bad()) {
    return absl::NotFoundError(absl::StrCat(path, ": cannot be read: ", std::strerror(errno)));
  }
  GivenValues given;
  try {
    for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(file)) {
      const std::string section = absl::StrJoin(item.parents, ".");
      if (section.empty() && item.name == "--") continue;  // the end of a section
      given[section.empty() ? item.name : absl::StrCat("[", section, "]")] = item.inputs;
    }
  } catch (const std::exception& error) {
    return absl::InvalidArgumentError(absl::StrCat(path, ": ", error.what()));
  }
  return given;
}

}  // namespace bccskel::server
