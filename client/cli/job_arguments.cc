#include "client/cli/job_arguments.h"

#include <CLI/CLI.hpp>
#include <string>

#include "client/cli/add_command.h"
#include "client/cli/choice_option.h"
#include "client/cli/server_arguments.h"
#include "client/cli/swc_argument.h"
#include "client/export/skeleton_file.h"

namespace bccskel::cli {
namespace {

void AddJson(CLI::App& command, CommonArguments& common) {
  command.add_flag_callback(
      "--json", [&common] { common.summary = SummaryStyle::kJson; },
      "Print the summary as one JSON object");
}

void AddJob(CLI::App& command, JobArguments& arguments) {
  command.add_option("JOB", arguments.job, "The job's name, as submit --detach prints it")
      ->required()
      ->option_text(" ");
  AddServer(command, arguments.server);
  AddJson(command, arguments.common);
}

void AddWaiting(CLI::App& command, WaitingArguments& waiting) {
  AddChoice<ProgressStyle>(command, "--progress", waiting.progress,
                           "Show the shells on standard error; auto (default): on a terminal",
                           {{"auto", ProgressStyle::kAuto},
                            {"always", ProgressStyle::kAlways},
                            {"never", ProgressStyle::kNever}});
  command.add_flag_callback(
      "--detach", [&waiting] { waiting.on_interrupt = OnInterrupt::kLeave; },
      "Let the job go on when Ctrl-C ends this command");
  command
      .add_option_function<double>(
          "--timeout",
          [&waiting](double seconds) {
            waiting.timeout = std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
          },
          "Stop waiting after this many seconds (default 3600); the job goes on")
      ->check(CLI::Range(0.001, 1e7))
      ->option_text("SECONDS");
}

void AddJobs(CLI::App& command, JobsArguments& arguments) {
  AddServer(command, arguments.server);
  command.add_option("--limit", arguments.limit, "The newest ones only (default 50)")
      ->check(CLI::Range(1, 1'000'000))
      ->option_text("N");
  AddJson(command, arguments.common);
}

void AddWatch(CLI::App& command, WatchArguments& arguments) {
  AddJob(command, arguments.job);
  AddWaiting(command, arguments.waiting);
}

void AddCancel(CLI::App& command, CancelArguments& arguments) { AddJob(command, arguments.job); }

void AddDelete(CLI::App& command, DeleteArguments& arguments) { AddJob(command, arguments.job); }

void AddFetch(CLI::App& command, FetchArguments& arguments) {
  AddJob(command, arguments.job);
  command
      .add_option("-o,--output", arguments.outputs,
                  "Output file, format by ending: " + exporting::SkeletonFormatEndings() +
                      "; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->option_text("FILE (required)");
  AddSwcStep(command, arguments.swc);
  command
      .add_option("--object", arguments.object,
                  "The volume that was submitted, which .svg and .html show")
      ->option_text("FILE");
  AddWaiting(command, arguments.waiting);
}

}  // namespace

JobCommands::JobCommands(CLI::App& app)
    : jobs_(AddCommand(app, "jobs", "List the jobs that a server keeps", jobs_arguments_, AddJobs)),
      watch_(AddCommand(app, "watch", "Wait for a job's end", watch_arguments_, AddWatch)),
      cancel_(
          AddCommand(app, "cancel", "End a job that waits or runs", cancel_arguments_, AddCancel)),
      delete_(AddCommand(app, "delete", "Erase a job and its result from the server",
                         delete_arguments_, AddDelete)),
      fetch_(AddCommand(app, "fetch", "Wait for a job's end and write its result", fetch_arguments_,
                        AddFetch)) {}

std::optional<Arguments> JobCommands::Chosen() const {
  if (jobs_.parsed()) return jobs_arguments_;
  if (watch_.parsed()) return watch_arguments_;
  if (cancel_.parsed()) return cancel_arguments_;
  if (delete_.parsed()) return delete_arguments_;
  if (fetch_.parsed()) return fetch_arguments_;
  return std::nullopt;
}

}  // namespace bccskel::cli
