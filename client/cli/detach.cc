#include "client/cli/detach.h"

#include <utility>

#include "client/cli/console.h"
#include "client/cli/job_calls.h"
#include "client/encoded_volume.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
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
  if (!job.ok()) return FailOnServer(arguments.server, job.status());
  const bool json = arguments.common.summary == SummaryStyle::kJson;
  return Print((json ? JobJson(*job) : job->name) + "\n");
}

}  // namespace bccskel::cli
