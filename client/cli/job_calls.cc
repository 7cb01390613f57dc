#include "client/cli/job_calls.h"

#include <utility>

#include "absl/time/time.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/encoded_volume.h"
#include "client/export/text.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

using client::DurableClient;

constexpr std::chrono::minutes kShortCall(1);
constexpr std::chrono::seconds kLastCall(3);  // after Ctrl-C

std::string TimeJson(const std::optional<client::Time>& time) {
  return time.has_value() ? JsonString(TimeText(*time)) : "null";
}

}  // namespace

absl::StatusOr<std::unique_ptr<DurableClient>> ClientOf(const ServerArguments& server,
                                                        const client::RetryPolicy& policy) {
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(server));
  BCCSKEL_ASSIGN_OR_RETURN(auto stub, client::MakeGrpcDurableStub(endpoint));
  return std::make_unique<DurableClient>(std::move(stub), policy);
}

absl::StatusOr<std::unique_ptr<DurableClient>> PatientClientOf(const JobArguments& arguments,
                                                               const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto client, ClientOf(arguments.server));
  absl::Status found = client->GetJob(arguments.job, ShortCalls(stop)).status();
  // After Ctrl-C the job must still be found, to cancel it.
  if (!found.ok() && stop.stop_requested()) {
    found = client->GetJob(arguments.job, {.timeout = kLastCall}).status();
  }
  BCCSKEL_RETURN_IF_ERROR(found);
  return ClientOf(arguments.server, client::kOutlastRestart);
}

DurableClient::Calls ShortCalls(const std::stop_token& stop) {
  return {.timeout = kShortCall, .stop = stop};
}

std::string TimeText(client::Time time) {
  return absl::FormatTime("%Y-%m-%dT%H:%M:%SZ", absl::FromChrono(time), absl::UTCTimeZone());
}

std::string JobJson(const client::DurableJob& job) {
  exporting::Text text;
  text.Add("{\"job\":", JsonString(job.name), ",\"state\":", JsonString(NameOf(job.state)),
           ",\"request_id\":", JsonString(job.request_id), ",\"volume\":", JsonString(job.volume),
           ",\"attempts\":", job.attempts, ",\"result_bytes\":", job.result_bytes,
           ",\"message\":", JsonString(std::string(job.error.message())),
           ",\"created\":", TimeJson(job.created), ",\"started\":", TimeJson(job.started),
           ",\"ended\":", TimeJson(job.ended), ",\"expires\":", TimeJson(job.expires), '}');
  return std::move(text).Take();
}

std::string JobSummary(const CommonArguments& common, const client::DurableJob& job) {
  if (common.summary == SummaryStyle::kJson) return JobJson(job) + "\n";
  return job.name + " " + NameOf(job.state) + "\n";
}

absl::Status AwaitJob(DurableClient& client, const std::string& job,
                      const WaitingArguments& waiting, const std::stop_token& stop) {
  ProgressBar bar(waiting.progress);
  absl::Status ended = client.Await(job, bar.Callback("waiting for " + job),
                                    {.timeout = waiting.timeout, .stop = stop});
  if (!ended.ok() && stop.stop_requested() && waiting.on_interrupt == OnInterrupt::kCancel) {
    BCCSKEL_RETURN_IF_ERROR(client.CancelJob(job, ShortCalls({})).status());
  }
  return ended;
}

namespace {

absl::StatusOr<client::DurableJob> MakeJob(const SkeletonizeArguments& arguments,
                                           const client::EncodedVolume& volume,
                                           const std::stop_token& stop) {
  const client::DurableClient::Calls calls = {.timeout = arguments.timeout, .stop = stop};
  BCCSKEL_ASSIGN_OR_RETURN(const auto client, ClientOf(arguments.server));
  client::NewJob job;
  BCCSKEL_ASSIGN_OR_RETURN(job.volume, client->Upload(volume, calls));
  job.options = arguments.skeletonize;
  job.thin_volume = arguments.thin_volume;
  job.threads = arguments.common.threads;
  return client->CreateJob(std::move(job), calls);
}

}  // namespace

ExitCode SubmitDetached(const SkeletonizeArguments& arguments, const Volume& object,
                        const std::stop_token& stop) {
  const auto volume = client::EncodeForSending(object, client::BestEncodingOf(object), stop);
  if (!volume.ok()) return Fail(volume.status());
  const absl::StatusOr<client::DurableJob> job = MakeJob(arguments, *volume, stop);
  if (!job.ok()) return FailOnServer(arguments.server, job.status(), LocalCommand(arguments));
  const bool json = arguments.common.summary == SummaryStyle::kJson;
  return Print((json ? JobJson(*job) : job->name) + "\n");
}

}  // namespace bccskel::cli
