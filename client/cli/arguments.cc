#include "client/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <initializer_list>
#include <list>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_split.h"
#include "client/cli/complaints.h"
#include "client/cli/console.h"
#include "core/version/version.h"

namespace bccskel::cli {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 success, 2 wrong command line, 3 input unreadable or invalid, 4 server\n"
    "unavailable, 5 deadline passed or job cancelled by the server, 6 internal error or topology\n"
    "not kept, 7 over a limit, 8 output cannot be written, 9 token missing, wrong or without\n"
    "permission, 130 interrupted (Ctrl-C), 143 terminated. See bccskel(1).";

// They run as printed, where the files they name are there.
std::string ExamplesOf(const std::string& command, std::span<const char* const> examples) {
  if (examples.empty()) return "";
  std::string text = "Examples:\n";
  for (const char* words : examples) text += "  bccskel " + command + " " + words + "\n";
  return text + "\n";
}

// `bccskel help COMMAND` is `bccskel COMMAND --help`.
std::vector<std::string> WithoutHelpCommand(std::vector<std::string> words) {
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

// The command that the scripts in completions/ call with the words of a command line.
constexpr std::string_view kComplete = "__complete";

class CommandLine {
 public:
  CommandLine() {
    AddCommands();
    AddBench();
    app_.require_subcommand(0, 1);  // not 1: CLI11 would not name a misspelled one
    app_.set_version_flag("--version", "bccskel " + std::string(Version()));
    app_.footer(kFooter);
    app_.failure_message([](const CLI::App* app, const CLI::Error& error) {
      const Complaint complaint = DescribeError(*app, error);
      const std::string name(ProgramName());
      std::string text = name + ": error: " + complaint.what + "\n";
      if (!complaint.hint.empty()) text += name + ": hint: " + complaint.hint + "\n";
      return text;
    });
  }

  CLI::App& app() { return app_; }
  // The named command with its options; of nested names, the last known one.
  CLI::App& Find(std::span<const std::string> names) {
    CLI::App* found = &app_;
    for (const std::string& name : names) {
      const auto inner = found->get_subcommands(
          [&](const CLI::App* command) { return command->get_name() == name; });
      if (inner.empty()) break;
      found = inner.front();
    }
    if (const auto add = option_adders_.find(found); add != option_adders_.end()) add->second();
    return *found;
  }
  // Needs: a command was given.
  const Arguments& given() const { return given_.back(); }

 private:
  // Adds the options only when the command is given: those of all commands are hundreds, and adding
  // them takes as long as the skeleton of a small object. Option groups therefore have a
  // parse_complete_callback(): CLI11 calls callback() only for those that existed before.
  template <typename T>
  void Add(CLI::App& parent, const char* name, void (*add_options)(CLI::App&, T&),
           const char* description, std::initializer_list<const char*> examples = {}) {
    CLI::App* command = parent.add_subcommand(name, description);
    command->footer(ExamplesOf(name, {examples.begin(), examples.end()}) + kFooter);
    const auto add = [=, this] { add_options(*command, std::get<T>(given_.emplace_back(T()))); };
    command->preparse_callback([add](size_t) { add(); });
    option_adders_[command] = add;
  }

  void AddCommands() {
    Add(app_, "skeletonize", AddSkeletonize, "Skeletonize a mesh, a volume or an image",
        {"model.stl -o model.json -o model.png",
         "scan.nrrd --label 3 --preset vessels -o vessels.swc"});
    Add(app_, "labels", AddLabels, "Skeletonize each label of an image",
        {"cells.nrrd -o \"cell-{label}.swc\" -o cells.csv"});
    Add(app_, "info", AddInfo, "Describe a mesh, a volume or an image", {"scan.nrrd"});
    Add(app_, "view", AddView, "Make an interactive HTML page of a result, which needs no network",
        {"model.json --object model.stl -o model.html"});
    Add(app_, "render", AddRender, "Draw a PNG picture of a result",
        {"model.json --object model.stl -o model.png --turn 120"});
    Add(app_, "convert", AddConvert, "Write a JSON result in other formats",
        {"model.json -o model.graphml -o model.csv"});
    Add(app_, "reconstruct", AddReconstruct,
        "Rebuild the object from a result's balls and measure the overlap",
        {"model.json --object model.stl -o rebuilt.exr"});
    Add(app_, "voxelize", AddVoxelize,
        "Fill a mesh or convert an image to a volume of bcc lattice points",
        {"model.stl --points 850k -o model.exr"});
    Add(app_, "submit", AddSubmit, "Skeletonize a volume on a server");
    Add(app_, "generate", AddGenerate, "Make a test object", {"tree --points 100k -o tree.exr"});
  }

  void AddBench() {
    CLI::App& bench =
        *app_.add_subcommand("bench", "Measure the speed of this machine or of a server");
    bench.require_subcommand(1);
    Add(bench, "core", AddBenchCore,
        "Measure the time and memory from a volume to its skeleton, without reading and writing");
    Add(bench, "server", AddBenchServer,
        "Measure latency and throughput of a server for several numbers of clients and volume "
        "sizes");
    Add(app_, "probe", AddProbe, "Check whether a server accepts calls");
    Add(app_, "top", AddTop, "Show the queue and the throughput of a server");
    Add(app_, "jobs", AddJobs, "List the jobs of a server");
    Add(app_, "watch", AddWatch, "Wait until a job ends");
    Add(app_, "cancel", AddCancel, "Cancel a waiting or running job");
    Add(app_, "delete", AddDelete, "Erase a job and its result from the server");
    Add(app_, "fetch", AddFetch, "Wait until a job ends and write its result");
  }

  CLI::App app_{"Curve skeletons by parallel thinning on the body-centered cubic grid", "bccskel"};
  std::map<const CLI::App*, std::function<void()>> option_adders_;
  std::list<Arguments> given_;  // of each given command; the last is innermost
};

// ---- Completion ----

// "word<tab>description" for each of `words` that begins with `prefix`.
struct Completions {
  std::string prefix;
  std::string text;

  void Add(const std::string& word, const std::string& description = "") {
    if (!word.starts_with(prefix)) return;
    text += word + '\t' + description.substr(0, description.find('\n')) + '\n';
  }
  // Lets the shell complete names of files.
  void AddFiles() { text += ":files\n"; }
};

void CompleteOptions(const CLI::App& command, Completions& completions) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty() || option->get_positional()) continue;
    completions.Add("--" + option->get_lnames().front(), option->get_description());
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (group->get_name().empty()) CompleteOptions(*group, completions);
  }
}

// The text of an option names its values (`ends|continues`) or their kind (`FILE`, `N`).
void CompleteValue(const CLI::Option& option, Completions& completions) {
  const std::string& text = option.get_option_text();
  if (text.starts_with("FILE")) return completions.AddFiles();
  if (text.find('|') == text.npos) return;
  const std::vector<std::string> values = absl::StrSplit(text, '|');
  for (const std::string& value : values) {
    if (std::ranges::none_of(value, absl::ascii_isupper)) completions.Add(value);
  }
}

// "One of ball, torus" lists the values of a positional argument; others are files.
void CompletePositional(const CLI::App& command, Completions& completions) {
  constexpr std::string_view kChoice = "One of ";
  for (const CLI::Option* option : command.get_options()) {
    const std::string& description = option->get_description();
    if (!option->get_positional() || !description.starts_with(kChoice)) continue;
    const std::vector<std::string> values =
        absl::StrSplit(description.substr(kChoice.size()), ", ");
    for (const std::string& value : values) completions.Add(value);
    return;
  }
  completions.AddFiles();
}

// The completions of the last of `words`.
std::string CompletionsOf(std::span<const std::string> words) {
  CommandLine line;
  const std::span<const std::string> before = words.first(words.size() - 1);
  CLI::App& command = line.Find(before);
  Completions completions = {words.back(), ""};
  const CLI::Option* option = before.empty() ? nullptr : command.get_option_no_throw(before.back());
  const auto commands =
      command.get_subcommands([](const CLI::App* inner) { return !inner->get_name().empty(); });
  if (option != nullptr && option->get_items_expected_max() > 0) {
    CompleteValue(*option, completions);
  } else if (words.back().starts_with("-")) {
    CompleteOptions(command, completions);
  } else if (!commands.empty()) {
    for (const CLI::App* inner : commands)
      completions.Add(inner->get_name(), inner->get_description());
  } else {
    CompletePositional(command, completions);
  }
  return completions.text;
}

ExitCode Refuse(const std::string& complaint) {
  return FailWith(ExitCode::kUsage, absl::InvalidArgumentError(complaint));
}

}  // namespace

std::variant<Arguments, ExitCode> ParseArguments(int argc, const char* const* argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.size() > 1 && words.front() == kComplete) {
    std::fputs(CompletionsOf(std::span(words).subspan(1)).c_str(), stdout);
    return ExitCode::kOk;
  }
  CommandLine line;
  try {
    std::vector<std::string> backwards = WithoutHelpCommand(words);
    std::ranges::reverse(backwards);  // CLI11 takes the words of a vector in reverse order
    line.app().parse(std::move(backwards));
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    if (line.app().exit(error, out, err) == 0) {
      const std::string unknown = UnknownWord(line.app(), GivenCommand(line.app()));
      return line.app().get_subcommands().empty() && !unknown.empty() ? Refuse(unknown)
                                                                      : Print(out.str());
    }
    std::fputs(err.str().c_str(), stderr);
    return ExitCode::kUsage;
  }
  if (line.app().get_subcommands().empty()) return Refuse(CommandRequired(line.app()));
  Arguments arguments = line.given();
  const absl::Status fit = Validate(arguments);
  if (!fit.ok()) return Refuse(std::string(fit.message()));
  return arguments;
}

}  // namespace bccskel::cli
