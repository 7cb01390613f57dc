#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/job_calls.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"

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

ExitCode Finish(const JobArguments& arguments, const absl::StatusOr<DurableJob>& job) {
  if (!job.ok()) return FailOnServer(arguments.server.address, job.status());
  return Print(JobSummary(arguments.common, *job));
}

}  // namespace

ExitCode Run(const WatchArguments& arguments, const std::stop_token& stop) {
  return Finish(arguments.job, Watch(arguments, stop));
}

ExitCode Run(const CancelArguments& arguments, const std::stop_token& stop) {
  return Finish(arguments.job, Cancel(arguments.job, stop));
}

ExitCode Run(const DeleteArguments& arguments, const std::stop_token& stop) {
  const absl::Status deleted = Delete(arguments.job, stop);
  if (!deleted.ok()) return FailOnServer(arguments.job.server.address, deleted);
  const bool json = arguments.job.common.summary == SummaryStyle::kJson;
  return Print(json ? "{\"deleted\":\"" + arguments.job.job + "\"}\n"
                    : arguments.job.job + " deleted\n");
}

ExitCode Run(const FetchArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<SkeletonizeResult> result = Fetch(arguments, stop);
  if (!result.ok()) return FailOnServer(arguments.job.server.address, result.status());
  const Volume no_object;  // the formats of this command do not show it
  const exporting::Subject subject = {*result, no_object, arguments.job.job};
  for (const std::string& path : arguments.outputs) {
    const absl::StatusOr<std::string> note = exporting::WriteSkeletonFile(path, subject);
    if (!note.ok()) return FailWith(ExitCode::kOutput, note.status());
    if (!note->empty()) Warn(path + ": " + *note);
  }
  return ExitCode::kOk;
}

}  // namespace bccskel::cli
