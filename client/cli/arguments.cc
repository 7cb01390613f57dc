#include "client/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <utility>

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

CLI::App& AddVoxelize(CLI::App& app, VoxelizeArguments& arguments) {
  CLI::App& command =
      *app.add_subcommand("voxelize", "Turn a mesh or an image into bcc lattice points");
  AddInput(command, "INPUT", arguments.input, "Mesh or image file");
  AddVolumeOutput(command, arguments.output);
  AddGrid(command, arguments.grid);
  AddImage(command, arguments.image);
  AddThreads(command, arguments.common, kThreadsHere);
  AddCommon(command, arguments.common);
  return command;
}

CLI::App& AddSubmit(CLI::App& app, SkeletonizeArguments& arguments) {
  CLI::App& command = *app.add_subcommand("submit", "Send a volume to a server for its skeleton");
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
  return command;
}

CLI::App& AddSkeletonize(CLI::App& app, SkeletonizeArguments& arguments) {
  CLI::App& command =
      *app.add_subcommand("skeletonize", "Make the skeleton of an object in one go");
  AddInput(command, "INPUT", arguments.input, "Mesh, volume or image file");
  AddOutputs(command, arguments.outputs);
  AddSwcStep(command, arguments.swc);
  AddGrid(command, arguments.grid);
  AddImage(command, arguments.image);
  AddSkeletonImages(command, arguments.images);
  CLI::Option_group& server = *command.add_option_group("Server", "A server that computes instead");
  CLI::Option* address = AddServer(server, arguments.server);
  arguments.place = Place::kHere;
  server.callback([&server, &arguments] {
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
  return command;
}

CLI::App& AddInfo(CLI::App& app, InfoArguments& arguments) {
  CLI::App& command = *app.add_subcommand("info", "Describe a mesh, a volume or an image");
  AddInput(command, "FILE", arguments.file, "Mesh, volume or image file");
  AddImage(command, arguments.image);
  AddThreads(command, arguments.common, kThreadsHere);
  AddCommon(command, arguments.common);
  return command;
}

// What commands that show a result share with those that make one.
CLI::App& WithGrid(CLI::App& command, ResultArguments& source, CommonArguments& common) {
  AddGrid(command, source.grid);
  AddImage(command, source.image);
  AddThreads(command, common, kThreadsHere);
  AddCommon(command, common);
  return command;
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
  CLI::App& voxelize = AddVoxelize(app, voxelize_arguments);
  CLI::App& submit = AddSubmit(app, submit_arguments);
  CLI::App& skeletonize = AddSkeletonize(app, skeletonize_arguments);
  CLI::App& labels = AddLabels(app, labels_arguments);
  CLI::App& info = AddInfo(app, info_arguments);
  CLI::App& view =
      WithGrid(AddView(app, view_arguments), view_arguments.source, view_arguments.common);
  CLI::App& render =
      WithGrid(AddRender(app, render_arguments), render_arguments.source, render_arguments.common);
  CLI::App& reconstruct = WithGrid(AddReconstruct(app, reconstruct_arguments),
                                   reconstruct_arguments.source, reconstruct_arguments.common);
  CLI::App& convert = AddConvert(app, convert_arguments);
  CLI::App& generate = AddGenerate(app, generate_arguments);
  CLI::App& bench = AddBench(app, bench_core_arguments);
  CLI::App& bench_server = AddBenchServer(bench, bench_server_arguments);
  CLI::App& probe = AddProbe(app, probe_arguments);
  CLI::App& top = AddTop(app, top_arguments);
  const JobCommands jobs{app};

  CommandLine() {
    AddThreads(labels, labels_arguments.common, kThreadsHere);
    AddCommon(labels, labels_arguments.common);
    AddCommon(generate, generate_arguments.common);
    AddCommon(convert, convert_arguments.common);
    app.require_subcommand(0, 1);  // not 1: CLI11 would not name a misspelled one
    app.set_version_flag("--version", "bccskel " + std::string(Version()));
    app.footer(kFooter);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
      return "bccskel: error: " + std::string(error.what()) +
             "\nbccskel: hint: --help lists it all\n";
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
