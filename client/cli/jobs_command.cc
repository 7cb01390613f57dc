#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/job_calls.h"
#include "client/cli/load_object.h"
#include "client/cli/option_values.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/cli/thinning_options.h"
#include "client/export/skeleton_file.h"
#include "client/export/text.h"
#include "client/view/render/subject_picture.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

void AddJob(CLI::App& command, JobArguments& arguments) {
  command.add_option("JOB", arguments.job, "The job's name, as submit --detach prints it")
      ->required()
      ->option_text(" ");
  AddServer(command, arguments.server);
  AddJson(command, arguments.common);
}

void AddWaiting(CLI::App& command, WaitingArguments& waiting) {
  AddProgress(command, waiting.progress);
  command.add_flag_callback(
      "--detach", [&waiting] { waiting.on_interrupt = OnInterrupt::kLeave; },
      "Let the job continue when Ctrl-C ends this command");
  AddSeconds(command, "--timeout", waiting.timeout,
             "Stop waiting after this many seconds (default 3600); the job continues");
}

}  // namespace

void AddJobs(CLI::App& command, JobsArguments& arguments) {
  AddServer(command, arguments.server);
  command
      .add_option("--limit", arguments.limit, "Maximum number of jobs, newest first (default 50)")
      ->check(Within(1, 1'000'000))
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
  AddOutputs(command, arguments.outputs);
  AddSwcStep(command, arguments.swc);
  command
      .add_option("--object", arguments.object,
                  "The volume that was submitted, which .svg, .png and .html show")
      ->option_text("FILE");
  AddWaiting(command, arguments.waiting);
}

namespace {

using client::DurableJob;

absl::StatusOr<DurableJob> Watch(const WatchArguments& arguments, const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto client, PatientClientOf(arguments.job, stop));
  BCCSKEL_RETURN_IF_ERROR(AwaitJob(*client, arguments.job.job, arguments.waiting, stop));
  return client->GetJob(arguments.job.job, ShortCalls(stop));
}

absl::StatusOr<DurableJob> Cancel(const JobArguments& arguments, const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto client, ClientOf(arguments.server));
  return client->CancelJob(arguments.job, ShortCalls(stop));
}

absl::Status Delete(const JobArguments& arguments, const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto client, ClientOf(arguments.server));
  return client->DeleteJob(arguments.job, ShortCalls(stop));
}

absl::StatusOr<SkeletonizeResult> Fetch(const FetchArguments& arguments,
                                        const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto client, PatientClientOf(arguments.job, stop));
  BCCSKEL_RETURN_IF_ERROR(AwaitJob(*client, arguments.job.job, arguments.waiting, stop));
  return client->Fetch(arguments.job.job, {.timeout = arguments.waiting.timeout, .stop = stop});
}

// The object to show; empty if none is given.
absl::StatusOr<Volume> ObjectOf(const FetchArguments& arguments, const exec::Context& context) {
  if (arguments.object.empty()) return Volume();
  const ProgressBar bar(arguments.waiting.progress);
  bar.Begin("reading", arguments.object);
  return ReadVolumeFile(arguments.object, {}, context);
}

std::string TitleOf(const FetchArguments& arguments) {
  return arguments.object.empty() ? arguments.job.job : std::string(FileName(arguments.object));
}

bool IsVolumeFile(const std::string& path) {
  const auto format = exporting::SkeletonFormatOf(path);
  return format.ok() && *format == exporting::SkeletonFormat::kVolume;
}

// Checks that the result has what the files show.
absl::Status CheckFetched(const FetchArguments& arguments, const Volume& object,
                          const SkeletonizeResult& result) {
  const uint64_t points = object.PointCount();
  if (!arguments.object.empty() && points != result.object_points) {
    return absl::InvalidArgumentError(absl::StrCat(arguments.object, ": has ", points,
                                                   " points; the volume of ", arguments.job.job,
                                                   " had ", result.object_points));
  }
  const auto volume = std::ranges::find_if(arguments.outputs, IsVolumeFile);
  const bool missing = result.thin.PointCount() == 0 && result.object_points > 0;
  if (volume == arguments.outputs.end() || !missing) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(*volume, ": ", arguments.job.job,
                                                 " was made without its thinned volume; ",
                                                 "submit --detach --thin-volume keeps it"));
}

std::string FetchSummary(const JobArguments& arguments, const std::vector<WrittenFile>& files) {
  if (arguments.common.summary == SummaryStyle::kText) return FilesText(files);
  return "{\"job\":" + JsonString(arguments.job) + ",\"outputs\":" + FilesJson(files) + "}\n";
}

ExitCode Finish(const JobArguments& arguments, const absl::StatusOr<DurableJob>& job) {
  if (!job.ok()) return FailOnServer(arguments.server, job.status());
  return Print(JobSummary(arguments.common, *job));
}

}  // namespace

ExitCode Run(const WatchArguments& arguments, const std::stop_token& stop) {
  return Finish(arguments.job, Watch(arguments, stop));
}

ExitCode Run(const CancelArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<DurableJob> job = Cancel(arguments.job, stop);
  const bool text = arguments.job.common.summary == SummaryStyle::kText;
  if (!job.ok() || job->state == client::JobState::kCancelled || !text) {
    return Finish(arguments.job, job);
  }
  return Print(absl::StrCat(job->name, " had ended before: ", NameOf(job->state), "\n"));
}

ExitCode Run(const DeleteArguments& arguments, const std::stop_token& stop) {
  const absl::Status deleted = Delete(arguments.job, stop);
  if (!deleted.ok()) return FailOnServer(arguments.job.server, deleted);
  const bool json = arguments.job.common.summary == SummaryStyle::kJson;
  return Print(json ? "{\"deleted\":" + JsonString(arguments.job.job) + "}\n"
                    : arguments.job.job + " deleted\n");
}

ExitCode Run(const FetchArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.job.common.threads, stop);
  const absl::StatusOr<Volume> object = ObjectOf(arguments, team.context());
  if (!object.ok()) return Fail(object.status());
  const absl::StatusOr<SkeletonizeResult> result = Fetch(arguments, stop);
  if (!result.ok()) return FailOnServer(arguments.job.server, result.status());
  const absl::Status fits = CheckFetched(arguments, *object, *result);
  if (!fits.ok()) return Fail(fits);
  const exporting::Subject subject = {.result = *result,
                                      .object = *object,
                                      .title = TitleOf(arguments),
                                      .context = team.context(),
                                      .swc = arguments.swc,
                                      .draw = view::DrawSubject};
  std::vector<WrittenFile> files;
  const ProgressBar bar(arguments.waiting.progress);
  for (const std::string& path : arguments.outputs) {
    bar.Begin("writing", path);
    absl::StatusOr<std::string> note = exporting::WriteSkeletonFile(path, subject);
    if (!note.ok()) return FailWith(ExitCode::kOutput, note.status());
    files.push_back({path, *std::move(note)});
  }
  return Print(FetchSummary(arguments.job, files));
}

namespace {

using client::DurableJob;

constexpr int kPageSize = 100;

absl::StatusOr<std::vector<DurableJob>> List(const JobsArguments& arguments,
                                             const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto client, ClientOf(arguments.server));
  std::vector<DurableJob> jobs;
  std::string token;
  do {
    const int wanted = std::min(kPageSize, arguments.limit - static_cast<int>(jobs.size()));
    BCCSKEL_ASSIGN_OR_RETURN(client::JobPage page,
                             client->ListJobs(wanted, token, ShortCalls(stop)));
    for (DurableJob& job : page.jobs) jobs.push_back(std::move(job));
    token = page.next_token;
  } while (!token.empty() && static_cast<int>(jobs.size()) < arguments.limit);
  return jobs;
}

std::string Table(const std::vector<DurableJob>& jobs) {
  std::string text =
      absl::StrFormat("%-39s %-10s %-21s %s\n", "JOB", "STATE", "CREATED", "MESSAGE");
  for (const DurableJob& job : jobs) {
    absl::StrAppendFormat(&text, "%-39s %-10s %-21s %s\n", job.name, NameOf(job.state),
                          TimeText(job.created), job.error.message());
  }
  return text;
}

std::string Json(const std::vector<DurableJob>& jobs) {
  exporting::Text text;
  text.Add("{\"jobs\":[");
  for (size_t n = 0; n < jobs.size(); ++n) text.Add(n == 0 ? "" : ",", JobJson(jobs[n]));
  return std::move(text.Add("]}\n")).Take();
}

}  // namespace

ExitCode Run(const JobsArguments& arguments, const std::stop_token& stop) {
  const auto jobs = List(arguments, stop);
  if (!jobs.ok()) return FailOnServer(arguments.server, jobs.status());
  return Print(arguments.common.summary == SummaryStyle::kJson ? Json(*jobs) : Table(*jobs));
}

}  // namespace bccskel::cli
