#include <algorithm>
#include <string>

#include "absl/strings/str_cat.h"
#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/job_calls.h"
#include "client/cli/load_object.h"
#include "client/cli/local_team.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
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

// Empty where none is shown.
absl::StatusOr<Volume> ObjectOf(const FetchArguments& arguments, const exec::Context& context) {
  if (arguments.object.empty()) return Volume();
  return ReadVolumeFile(arguments.object, {}, context);
}

std::string TitleOf(const FetchArguments& arguments) {
  return arguments.object.empty() ? arguments.job.job : std::string(FileName(arguments.object));
}

bool IsVolumeFile(const std::string& path) {
  const auto format = exporting::SkeletonFormatOf(path);
  return format.ok() && *format == exporting::SkeletonFormat::kVolume;
}

// Whether the result has what the files show.
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
  return Print(json ? "{\"deleted\":\"" + arguments.job.job + "\"}\n"
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
                                      .swc = arguments.swc};
  for (const std::string& path : arguments.outputs) {
    const absl::StatusOr<std::string> note = exporting::WriteSkeletonFile(path, subject);
    if (!note.ok()) return FailWith(ExitCode::kOutput, note.status());
    if (!note->empty()) Warn(path + ": " + *note);
  }
  return ExitCode::kOk;
}

}  // namespace bccskel::cli
