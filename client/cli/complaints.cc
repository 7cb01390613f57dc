#include "client/cli/complaints.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/console.h"
#include "client/cli/option_values.h"
#include "client/export/skeleton_file.h"

namespace bccskel::cli {
namespace {

// Empty: none, because errors of values state the choice.
std::string HintFor(std::string_view error, const CLI::App& command) {
  const auto says = [error](std::string_view what) { return error.find(what) != error.npos; };
  if (says("--object ") && says(" required")) {
    return "--object names the mesh, volume or image that the result was made from; `bccskel view` "
           "and `bccskel render` show a result without it";
  }
  constexpr std::array kForOneObject = {"--range", "--threshold", "--below", "--invert"};
  if (error.starts_with("labels has no option ") && std::ranges::any_of(kForOneObject, says)) {
    return "labels makes an object of each value, or of those of --label; skeletonize makes one "
           "object of a range or threshold";
  }
  constexpr std::array kSeeHelp = {" is required", " are required", " has no option ",
                                   "there is no command "};
  if (std::ranges::none_of(kSeeHelp, says)) return "";
  std::string words = " --help";
  for (const CLI::App* at = &command; at->get_parent() != nullptr; at = at->get_parent()) {
    words = absl::StrCat(" ", at->get_name(), words);
  }
  return "see " + std::string(ProgramName()) + words;
}

// The error for all options that must be given and are not, of which CLI11 names the first.
std::string Required(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_required() && option->count() == 0) names.push_back(option->get_name());
  }
  if (names.empty()) return "";
  if (names.size() == 1) return names[0] + " is required";
  const std::string last = " and " + names.back();
  names.pop_back();
  return absl::StrCat(absl::StrJoin(names, ", "), last, " are required");
}

// The number of letters to change, add or remove to turn one word into the other.
size_t EditDistance(std::string_view one, std::string_view other) {
  std::vector<size_t> row(other.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < one.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < other.size(); ++j) {
      const size_t changed = diagonal + (one[i] == other[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

// "; did you mean ...?" if a known word is similar.
std::string Suggestion(const std::string& word, const std::vector<std::string>& known) {
  const auto distance = [&](const std::string& name) { return EditDistance(word, name); };
  const auto nearest = std::ranges::min_element(known, {}, distance);
  if (nearest == known.end() || 3 * distance(*nearest) > word.size()) return "";
  return "; did you mean " + *nearest + "?";
}

void AddOptionNames(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (group->get_name().empty()) AddOptionNames(*group, names);
  }
}

// The subcommands of a command, as of `bench`.
std::vector<std::string> CommandsOf(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* inner : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (!inner->get_name().empty()) names.push_back(inner->get_name());
  }
  return names;
}

}  // namespace

std::string CommandRequired(const CLI::App& app) {
  return "a command is required: " + absl::StrJoin(CommandsOf(app), ", ");
}

const CLI::App& GivenCommand(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

std::string UnknownWord(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> rest = app.remaining(true);
  std::vector<std::string> known = CommandsOf(command);
  if (!known.empty() && !rest.empty() && !rest.front().starts_with("-")) {
    const std::string before = &command == &app ? "" : command.get_name() + " ";
    return "there is no command " + before + rest.front() + Suggestion(rest.front(), known);
  }
  if (&command != &app && !known.empty() && rest.empty()) return CommandRequired(command);
  known.clear();
  const auto found = std::ranges::find_if(rest, [](const std::string& word) {
    return word.starts_with("-") && word != "-" && word != "--";
  });
  if (found == rest.end()) return "";
  AddOptionNames(command, known);
  const std::string option = found->substr(0, found->find('='));
  if (std::ranges::count(known, option) > 0) {
    return option + " stands before its command; write bccskel " + command.get_name() + " " +
           option;
  }
  return command.get_name() + " has no option " + option + Suggestion(option, known);
}

namespace {

// About more files than the command takes; nullopt: it has not been given more.
std::optional<Complaint> TooManyFiles(const std::vector<std::string>& rest,
                                      const CLI::App& command) {
  const auto files = command.get_options([](const CLI::Option* o) { return o->get_positional(); });
  if (rest.empty() || files.empty()) return std::nullopt;
  const std::string name = files.front()->get_name(true);
  const std::string what = absl::StrCat("unexpected argument",
                                        rest.size() == 1 ? ": " : "s: ", absl::StrJoin(rest, ", "),
                                        "; ", command.get_name(), " takes one ", name);
  double number = 0;
  const CLI::Option* size = command.get_option_no_throw("--voxel-size");
  if (size != nullptr && size->count() > 0 && std::ranges::any_of(rest, [&](const auto& word) {
        return absl::SimpleAtod(word, &number);
      })) {
    return Complaint{what,
                     "separate the numbers of an option by commas, such as --voxel-size 1,1,2.5"};
  }
  if (rest.size() == 1 && command.get_option_no_throw("--object") != nullptr) {
    return Complaint{what, "--object " + rest.front() +
                               " names the mesh, volume or image that the result was made from"};
  }
  const bool writes = command.get_option_no_throw("--output") != nullptr;
  return Complaint{
      what, "run it once for each " + name + (writes ? ", and write -o before each output" : "")};
}

}  // namespace

Complaint DescribeError(const CLI::App& app, const CLI::Error& error) {
  const CLI::App& command = GivenCommand(app);
  const std::vector<std::string> rest = app.remaining(true);
  std::string what = UnknownWord(app, command);
  if (what.empty() && dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    if (const auto complaint = TooManyFiles(rest, command)) return *complaint;
  }
  if (what.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    what = Required(command);
  }
  if (what.empty()) what = InWords(error.what());
  if (what == "--output is required" && rest.size() == 1 &&
      exporting::SkeletonFormatOf(rest.front()).ok()) {
    return {what, "write -o before " + rest.front()};
  }
  return {what, HintFor(what, command)};
}

}  // namespace bccskel::cli
