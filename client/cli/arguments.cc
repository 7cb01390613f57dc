#include "client/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <utility>

#include "client/cli/add_command.h"
#include "client/cli/bench_arguments.h"
#include "client/cli/choice_option.h"
#include "client/cli/complaints.h"
#include "client/cli/generate_arguments.h"
#include "client/cli/grid_arguments.h"
#include "client/cli/job_arguments.h"
#include "client/cli/labels_arguments.h"
#include "client/cli/operations_arguments.h"
#include "client/cli/result_arguments.h"
#include "client/cli/swc_argument.h"
#include "client/cli/thinning_arguments.h"
#include "client/export/skeleton_file.h"
#include "core/version/version.h"

// Only the files of arguments include CLI11, which is slow to compile.

namespace bccskel::cli {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 success, 2 wrong command line, 3 input cannot be read or is not what it should\n"
    "be, 4 server unavailable, 5 deadline passed or job cancelled by the server, 6 internal error\n"
    "or topology not kept, 7 over a limit, 8 output cannot be written, 9 token missing, wrong or\n"
    "not for this, 130 interrupted (Ctrl-C), 143 terminated. See bccskel(1).";

void AddCommon(CLI::App& command, CommonArguments& common) {
  command.add_flag_callback(
      "--json", [&common] { common.summary = SummaryStyle::kJson; },
      "Print the summary as one JSON object");
}

void AddThreads(CLI::App& command, CommonArguments& common, const char* description) {
  command.add_option("--threads", common.threads, description)
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
}

constexpr const char* kThreadsHere = "Threads to use; 0 means all of this machine (default)";
constexpr const char* kThreadsBoth =
    "Threads to use, here and on the server; 0 means all of this machine and what the server "
    "gives (default)";

void AddInput(CLI::App& command, const char* name, std::string& path, const char* description) {
  command.add_option(name, path, description)->required()->option_text(" ");
}

void AddVolumeOutput(CLI::App& command, std::string& path) {
  command.add_option("-o,--output", path, "Volume to write: .exr or .bccb")
      ->required()
      ->option_text("FILE (required)");
}

void AddOutputs(CLI::App& command, std::vector<std::string>& outputs) {
  command
      .add_option("-o,--output", outputs,
                  "Output file, format by ending: " + exporting::SkeletonFormatEndings() +
                      "; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->option_text("FILE (required)");
}

void AddProgress(CLI::App& command, SkeletonizeArguments& arguments) {
  AddChoice<ProgressStyle>(command, "--progress", arguments.progress,
                           "Show the shells on standard error; auto (default): on a terminal",
                           {{"auto", ProgressStyle::kAuto},
                            {"always", ProgressStyle::kAlways},
                            {"never", ProgressStyle::kNever}});
  command
      .add_option_function<double>(
          "--timeout",
          [&arguments](double seconds) {
            arguments.timeout = std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
          },
          "Give up after this many seconds (default 3600)")
      ->check(CLI::Range(0.001, 1e7))
      ->option_text("SECONDS");
}

void AddVoxelize(CLI::App& command, VoxelizeArguments& arguments) {
  AddInput(command, "INPUT", arguments.input, "Mesh or image file");
  AddVolumeOutput(command, arguments.output);
  AddGrid(command, arguments.grid);
  AddImage(command, arguments.image);
  AddThreads(command, arguments.common, kThreadsHere);
  AddCommon(command, arguments.common);
}

void AddSubmit(CLI::App& command, SkeletonizeArguments& arguments) {
  arguments.accepted = AcceptedInput::kVolumeOnly;
  AddInput(command, "VOLUME", arguments.input, "Volume file, .exr or .bccb");
  AddOutputs(command, arguments.outputs);
  AddSwcStep(command, arguments.swc);
  command.get_option("--output")->required(false)->option_text("FILE (required unless detached)");
  AddServer(command, arguments.server);
  command.add_flag_callback(
      "--detach", [&arguments] { arguments.waiting = Waiting::kDetach; },
      "Print the job's name and end; the server keeps the job (see fetch)");
  command.add_flag_callback(
      "--thin-volume", [&arguments] { arguments.thin_volume = client::ThinVolume::kReturn; },
      "With --detach: keep the thinned volume, too, which fetch can write then");
  AddSkeletonOptions(command, arguments.skeletonize, arguments.root);
  AddThreads(command, arguments.common, kThreadsBoth);
  AddProgress(command, arguments);
  AddCommon(command, arguments.common);
}

void AddSkeletonize(CLI::App& command, SkeletonizeArguments& arguments) {
  AddInput(command, "INPUT", arguments.input, "Mesh, volume or image file");
  AddOutputs(command, arguments.outputs);
  AddSwcStep(command, arguments.swc);
  AddGrid(command, arguments.grid);
  AddImage(command, arguments.image);
  AddSkeletonImages(command, arguments.images);
  CLI::Option_group& server = *command.add_option_group("Server", "A server that computes instead");
  CLI::Option* address = AddServer(server, arguments.server);
  arguments.place = Place::kHere;
  server.parse_complete_callback([&server, &arguments] {
    if (server.count_all() > 0) arguments.place = Place::kServer;
  });
  command
      .add_flag_callback(
          "--local", [&arguments] { arguments.place = Place::kLocal; },
          "Compute on this machine, without a server (default, unless a server is named)")
      ->excludes(address);
  AddSkeletonOptions(command, arguments.skeletonize, arguments.root);
  AddThreads(command, arguments.common, kThreadsBoth);
  AddProgress(command, arguments);
  AddCommon(command, arguments.common);
}

void AddInfo(CLI::App& command, InfoArguments& arguments) {
  AddInput(command, "FILE", arguments.file, "Mesh, volume or image file");
  AddImage(command, arguments.image);
  AddThreads(command, arguments.common, kThreadsHere);
  AddCommon(command, arguments.common);
}

// The options of a command that shows a result, with those it shares with commands that make one.
template <typename Arguments, void (*kAddOwn)(CLI::App&, Arguments&)>
void AddWithGrid(CLI::App& command, Arguments& arguments) {
  kAddOwn(command, arguments);
  AddGrid(command, arguments.source.grid);
  AddImage(command, arguments.source.image);
  AddThreads(command, arguments.common, kThreadsHere);
  AddCommon(command, arguments.common);
}

void AddLabelsHere(CLI::App& command, LabelsArguments& arguments) {
  AddLabels(command, arguments);
  AddThreads(command, arguments.common, kThreadsHere);
  AddCommon(command, arguments.common);
}

void AddConvertHere(CLI::App& command, ConvertArguments& arguments) {
  AddConvert(command, arguments);
  AddCommon(command, arguments.common);
}

void AddGenerateHere(CLI::App& command, GenerateArguments& arguments) {
  AddGenerate(command, arguments);
  AddCommon(command, arguments.common);
}

CLI::App& AddBench(CLI::App& app, BenchCoreArguments& arguments) {
  CLI::App& bench =
      *app.add_subcommand("bench", "Measure the speed of this machine or of a server");
  bench.require_subcommand(1);
  AddCommand(bench, "core", "Time and memory from a volume in memory to its skeleton in memory",
             arguments, AddBenchCore);
  return bench;
}

std::string HintFor(std::string_view error) {
  if (error == "--object is required") {
    return "--object names the mesh, volume or image that the result was made from; `bccskel view` "
           "also shows a result without it";
  }
  return "--help lists it all";
}

// All commands, each with what it fills in.
struct CommandLine {
  CLI::App app{"Curve skeletons by parallel thinning on the body-centered cubic grid", "bccskel"};
  VoxelizeArguments voxelize_arguments;
  SkeletonizeArguments submit_arguments;
  SkeletonizeArguments skeletonize_arguments;
  LabelsArguments labels_arguments;
  InfoArguments info_arguments;
  ViewArguments view_arguments;
  RenderArguments render_arguments;
  ConvertArguments convert_arguments;
  ReconstructArguments reconstruct_arguments;
  GenerateArguments generate_arguments;
  BenchCoreArguments bench_core_arguments;
  BenchServerArguments bench_server_arguments;
  ProbeArguments probe_arguments;
  TopArguments top_arguments;
  CLI::App& voxelize =
      AddCommand(app, "voxelize", "Turn a mesh or an image into bcc lattice points",
                 voxelize_arguments, AddVoxelize);
  CLI::App& submit = AddCommand(app, "submit", "Send a volume to a server for its skeleton",
                                submit_arguments, AddSubmit);
  CLI::App& skeletonize = AddCommand(app, "skeletonize", "Make the skeleton of an object in one go",
                                     skeletonize_arguments, AddSkeletonize);
  CLI::App& labels =
      AddCommand(app, "labels", "Make a skeleton of every label of an image, on this machine",
                 labels_arguments, AddLabelsHere);
  CLI::App& info =
      AddCommand(app, "info", "Describe a mesh, a volume or an image", info_arguments, AddInfo);
  CLI::App& view =
      AddCommand(app, "view", "Make a page to look at a result in a browser, without a network",
                 view_arguments, AddWithGrid<ViewArguments, AddView>);
  CLI::App& render = AddCommand(app, "render", "Draw a picture of a result", render_arguments,
                                AddWithGrid<RenderArguments, AddRender>);
  CLI::App& reconstruct =
      AddCommand(app, "reconstruct", "Make a volume of a result's balls and compare it",
                 reconstruct_arguments, AddWithGrid<ReconstructArguments, AddReconstruct>);
  CLI::App& convert = AddCommand(app, "convert", "Write a result in other formats",
                                 convert_arguments, AddConvertHere);
  CLI::App& generate =
      AddCommand(app, "generate", "Make a test object", generate_arguments, AddGenerateHere);
  CLI::App& bench = AddBench(app, bench_core_arguments);
  CLI::App& bench_server =
      AddCommand(bench, "server",
                 "Latency and throughput of a server, for numbers of clients and sizes of volume",
                 bench_server_arguments, AddBenchServer);
  CLI::App& probe =
      AddCommand(app, "probe", "Ask a server whether it takes calls", probe_arguments, AddProbe);
  CLI::App& top = AddCommand(app, "top", "Watch the queue and the throughput of a server",
                             top_arguments, AddTop);
  const JobCommands jobs{app};

  CommandLine() {
    app.require_subcommand(0, 1);  // not 1: CLI11 would not name a misspelled one
    app.set_version_flag("--version", "bccskel " + std::string(Version()));
    app.footer(kFooter);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
      const std::string what = error.what();
      return "bccskel: error: " + what + "\nbccskel: hint: " + HintFor(what) + "\n";
    });
    for (CLI::App* command : app.get_subcommands({})) command->footer(kFooter);
  }

  // Needs: a command was given.
  Arguments Chosen() const {
    if (voxelize.parsed()) return voxelize_arguments;
    if (submit.parsed()) return submit_arguments;
    if (skeletonize.parsed()) return skeletonize_arguments;
    if (labels.parsed()) return labels_arguments;
    if (info.parsed()) return info_arguments;
    if (view.parsed()) return view_arguments;
    if (render.parsed()) return render_arguments;
    if (convert.parsed()) return convert_arguments;
    if (reconstruct.parsed()) return reconstruct_arguments;
    if (generate.parsed()) return generate_arguments;
    if (probe.parsed()) return probe_arguments;
    if (top.parsed()) return top_arguments;
    if (auto chosen = jobs.Chosen()) return *std::move(chosen);
    if (bench_server.parsed()) return bench_server_arguments;
    return bench_core_arguments;
  }
};

std::string CommandRequired(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return "a command is required: " + names;
}

ExitCode Refuse(const std::string& complaint) {
  std::fprintf(stderr, "bccskel: error: %s\n", complaint.c_str());
  return ExitCode::kUsage;
}

}  // namespace

std::variant<Arguments, ExitCode> ParseArguments(int argc, const char* const* argv) {
  CommandLine line;
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return line.app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  if (line.app.get_subcommands().empty()) return Refuse(CommandRequired(line.app));
  Arguments arguments = line.Chosen();
  const std::optional<std::string> complaint = ComplaintAbout(arguments);
  if (complaint.has_value()) return Refuse(*complaint);
  return arguments;
}

}  // namespace bccskel::cli
