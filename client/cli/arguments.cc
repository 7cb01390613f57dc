#include "client/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_split.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/option_values.h"
#include "client/cli/thinning_options.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"
#include "core/version/version.h"

namespace bccskel::cli {
namespace {

using Complaint = std::optional<std::string>;

Complaint IfError(const absl::Status& status) {
  if (status.ok()) return std::nullopt;
  return std::string(status.message());
}

Complaint VolumeOutputComplaint(const std::string& path) {
  const absl::StatusOr<exporting::SkeletonFormat> format = exporting::SkeletonFormatOf(path);
  if (format.ok() && *format == exporting::SkeletonFormat::kVolume) return std::nullopt;
  return path + ": a volume file ends in .exr or .bccb";
}

// Writing over the input would destroy what cannot be computed again.
Complaint OverwriteComplaint(const std::string& input, const std::string& output) {
  std::error_code none;
  if (!std::filesystem::equivalent(input, output, none)) return std::nullopt;
  return output + ": is the input, too, and would be overwritten";
}

// Options that say how to make an object are for one kind of input each.
Complaint ObjectComplaint(const std::string& input, const VoxelizeOptions& grid,
                          const ImageArguments& image) {
  if (Complaint c = IfError(ForegroundOf(image).status()); c.has_value()) return c;
  const absl::StatusOr<InputKind> kind = InputKindOf(input, image);
  if (!kind.ok()) return std::nullopt;
  const std::string is = "; " + input + " is " + std::string(InputKindPhrase(*kind));
  const bool grid_given =
      grid.points.has_value() || grid.spacing.has_value() || grid.fill != FillRule::kAuto;
  if (grid_given && *kind != InputKind::kMesh) {
    return "--points, --spacing and --fill are for meshes" + is;
  }
  if (!image.given || *kind == InputKind::kImage) return std::nullopt;
  return "--label, --range, --threshold and the like are for images" + is;
}

Complaint ImagesComplaint(const SkeletonizeArguments& arguments) {
  if (!arguments.images.wanted()) return std::nullopt;
  for (const std::string& path : {arguments.images.branches, arguments.images.curves}) {
    if (!path.empty() && !path.ends_with(".nrrd")) return path + ": does not end in .nrrd";
    if (Complaint c = OverwriteComplaint(arguments.input, path); c.has_value()) return c;
  }
  if (arguments.skeletonize.preparing.Wanted()) {
    return "--branch-image and --curve-image show the voxels as they are, so not with --denoise, "
           "--fill-cavities, --cut-loops, --min-component, --min-component-volume or "
           "--keep-largest";
  }
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.input, arguments.image);
  if (!kind.ok() || *kind == InputKind::kImage) return std::nullopt;
  return "--branch-image and --curve-image are for images; " + arguments.input + " is " +
         std::string(InputKindPhrase(*kind));
}

Complaint ComplaintAbout(const SkeletonizeArguments& arguments) {
  const bool detached = arguments.waiting == Waiting::kDetach;
  if (!detached && arguments.outputs.empty()) return "--output is required";
  if (detached && !arguments.outputs.empty()) {
    return "--detach writes no files; bccskel fetch does, when the job has ended";
  }
  if (!detached && arguments.thin_volume == client::ThinVolume::kReturn) {
    return "--thin-volume is for --detach; without it -o FILE.exr or FILE.bccb asks for the volume";
  }
  for (const std::string& output : arguments.outputs) {
    if (Complaint c = IfError(exporting::SkeletonFormatOf(output).status()); c.has_value())
      return c;
    if (Complaint c = OverwriteComplaint(arguments.input, output); c.has_value()) return c;
  }
  if (Complaint c = ObjectComplaint(arguments.input, arguments.grid, arguments.image);
      c.has_value()) {
    return c;
  }
  if (Complaint c = ImagesComplaint(arguments); c.has_value()) return c;
  return ComplaintAboutOptions(arguments.skeletonize);
}

Complaint ComplaintAbout(const VoxelizeArguments& arguments) {
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.input, arguments.image);
  const bool sized = arguments.grid.points.has_value() || arguments.grid.spacing.has_value();
  if (!sized && kind.ok() && *kind == InputKind::kMesh) {
    return "voxelize needs --points or --spacing for a mesh";
  }
  if (Complaint c = VolumeOutputComplaint(arguments.output); c.has_value()) return c;
  return ObjectComplaint(arguments.input, arguments.grid, arguments.image);
}

Complaint ComplaintAbout(const GenerateArguments& arguments) {
  return VolumeOutputComplaint(arguments.output);
}

Complaint ResultComplaint(const ResultArguments& source, const std::string& output) {
  for (const std::string& input : {source.result, source.object}) {
    if (Complaint c = OverwriteComplaint(input, output); c.has_value()) return c;
  }
  return ObjectComplaint(source.object, source.grid, source.image);
}

Complaint ComplaintAbout(const ViewArguments& arguments) {
  return ResultComplaint(arguments.source, arguments.output);
}
Complaint ComplaintAbout(const RenderArguments& arguments) {
  return ResultComplaint(arguments.source, arguments.output);
}
Complaint ComplaintAbout(const ReconstructArguments& arguments) {
  return ResultComplaint(arguments.source, arguments.output);
}
Complaint ComplaintAbout(const LabelsArguments& arguments) {
  for (const std::string& output : arguments.outputs) {
    if (Complaint c = IfError(CheckLabelOutput(output)); c.has_value()) return c;
    if (Complaint c = OverwriteComplaint(arguments.input, output); c.has_value()) return c;
  }
  if (Complaint c = ComplaintAboutRootOfLabels(arguments.root); c.has_value()) return c;
  return ComplaintAboutOptions(arguments.skeletonize);
}

Complaint FetchComplaint(const std::string& object, const std::string& output) {
  using exporting::SkeletonFormat;
  const absl::StatusOr<SkeletonFormat> format = exporting::SkeletonFormatOf(output);
  if (!format.ok()) return IfError(format.status());
  const bool shows_object = *format == SkeletonFormat::kSvg || *format == SkeletonFormat::kHtml;
  if (shows_object && object.empty()) {
    return output + ": shows the object, too: name the volume that was submitted with --object";
  }
  return OverwriteComplaint(object, output);
}

Complaint ComplaintAbout(const FetchArguments& arguments) {
  for (const std::string& output : arguments.outputs) {
    if (Complaint c = FetchComplaint(arguments.object, output); c.has_value()) return c;
  }
  return arguments.object.empty() ? std::nullopt : VolumeOutputComplaint(arguments.object);
}

Complaint ComplaintAbout(const InfoArguments& arguments) {
  return ObjectComplaint(arguments.file, {}, arguments.image);
}

template <typename Other>
Complaint ComplaintAbout(const Other&) {
  return std::nullopt;
}

constexpr const char* kFooter =
    "Exit codes: 0 success, 2 wrong command line, 3 input cannot be read or is not what it should\n"
    "be, 4 server unavailable, 5 deadline passed or job cancelled by the server, 6 internal error\n"
    "or topology not kept, 7 over a limit, 8 output cannot be written, 9 token missing, wrong or\n"
    "not for this, 130 interrupted (Ctrl-C), 143 terminated. See bccskel(1).";

std::string HintFor(std::string_view error) {
  if (error == "--object is required") {
    return "--object names the mesh, volume or image that the result was made from; `bccskel view` "
           "also shows a result without it";
  }
  return "--help lists it all";
}

// The command that completions/ call with the words of a command line.
constexpr std::string_view kComplete = "__complete";

class CommandLine {
 public:
  CommandLine() {
    AddCommands();
    AddBench();
    app_.require_subcommand(0, 1);  // not 1: CLI11 would not name a misspelled one
    app_.set_version_flag("--version", "bccskel " + std::string(Version()));
    app_.footer(kFooter);
    app_.failure_message([](const CLI::App*, const CLI::Error& error) {
      const std::string what = error.what();
      return "bccskel: error: " + what + "\nbccskel: hint: " + HintFor(what) + "\n";
    });
    for (CLI::App* command : app_.get_subcommands({})) command->footer(kFooter);
  }

  CLI::App& app() { return app_; }
  // The command named, with its options; the last one that is known where names are nested.
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
  // Options are added when the command is given: all commands have hundreds, which take as long as
  // the skeleton of a small object. Option groups among them have a parse_complete_callback():
  // CLI11 calls callback() only of those that were there before.
  template <typename T>
  void Add(CLI::App& parent, const char* name, void (*add_options)(CLI::App&, T&),
           const char* description) {
    CLI::App* command = parent.add_subcommand(name, description);
    const auto add = [=, this] { add_options(*command, std::get<T>(given_.emplace_back(T()))); };
    command->preparse_callback([add](size_t) { add(); });
    option_adders_[command] = add;
  }

  void AddCommands() {
    Add(app_, "voxelize", AddVoxelize, "Turn a mesh or an image into bcc lattice points");
    Add(app_, "submit", AddSubmit, "Send a volume to a server for its skeleton");
    Add(app_, "skeletonize", AddSkeletonize, "Make the skeleton of an object in one go");
    Add(app_, "labels", AddLabelsCommand,
        "Make a skeleton of every label of an image, on this machine");
    Add(app_, "info", AddInfo, "Describe a mesh, a volume or an image");
    Add(app_, "view", AddView, "Make a page to look at a result in a browser, without a network");
    Add(app_, "render", AddRender, "Draw a picture of a result");
    Add(app_, "reconstruct", AddReconstruct, "Make a volume of a result's balls and compare it");
    Add(app_, "convert", AddConvert, "Write a result in other formats");
    Add(app_, "generate", AddGenerate, "Make a test object");
  }

  void AddBench() {
    CLI::App& bench =
        *app_.add_subcommand("bench", "Measure the speed of this machine or of a server");
    bench.require_subcommand(1);
    Add(bench, "core", AddBenchCore,
        "Time and memory from a volume in memory to its skeleton in memory");
    Add(bench, "server", AddBenchServer,
        "Latency and throughput of a server, for numbers of clients and sizes of volume");
    Add(app_, "probe", AddProbe, "Ask a server whether it takes calls");
    Add(app_, "top", AddTop, "Watch the queue and the throughput of a server");
    Add(app_, "jobs", AddJobs, "List the jobs that a server keeps");
    Add(app_, "watch", AddWatch, "Wait for a job's end");
    Add(app_, "cancel", AddCancel, "End a job that waits or runs");
    Add(app_, "delete", AddDelete, "Erase a job and its result from the server");
    Add(app_, "fetch", AddFetch, "Wait for a job's end and write its result");
  }

  CLI::App app_{"Curve skeletons by parallel thinning on the body-centered cubic grid", "bccskel"};
  std::map<const CLI::App*, std::function<void()>> option_adders_;
  std::list<Arguments> given_;  // by the options of each command given, the last one's behind
};

std::string CommandRequired(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return "a command is required: " + names;
}

// ---- Completion ----

// "word<tab>description" for each of `words` that begins with `prefix`.
struct Completions {
  std::string prefix;
  std::string text;

  void Add(const std::string& word, const std::string& description = "") {
    if (!word.starts_with(prefix)) return;
    text += word + '\t' + description.substr(0, description.find('\n')) + '\n';
  }
  // The shell completes the names of files.
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

// "One of ball, torus": the values of a positional; others are files.
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

// What may stand in place of the last of `words`.
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
  std::fprintf(stderr, "bccskel: error: %s\n", complaint.c_str());
  return ExitCode::kUsage;
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
    line.app().parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return line.app().exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  if (line.app().get_subcommands().empty()) return Refuse(CommandRequired(line.app()));
  Arguments arguments = line.given();
  const Complaint complaint =
      std::visit([](const auto& chosen) { return ComplaintAbout(chosen); }, arguments);
  if (complaint.has_value()) return Refuse(*complaint);
  return arguments;
}

namespace {

template <typename Chosen>
std::vector<std::string> OutputsOf(const Chosen& arguments) {
  std::vector<std::string> paths;
  if constexpr (requires { arguments.outputs; }) paths = arguments.outputs;
  if constexpr (requires { arguments.output; }) paths.push_back(arguments.output);
  if constexpr (requires { arguments.images; }) {
    for (const std::string& path : {arguments.images.branches, arguments.images.curves}) {
      if (!path.empty()) paths.push_back(path);
    }
  }
  return paths;
}

}  // namespace

absl::Status CheckOutputs(const Arguments& arguments) {
  const std::vector<std::string> paths =
      std::visit([](const auto& chosen) { return OutputsOf(chosen); }, arguments);
  for (const std::string& path : paths) {
    // Which folders a label's number names is not known yet.
    if (path.rfind('/') != path.npos && path.find(kLabelPlace) < path.rfind('/')) continue;
    BCCSKEL_RETURN_IF_ERROR(exporting::CheckOutput(path));
  }
  return absl::OkStatus();
}

}  // namespace bccskel::cli
