#ifndef BCCSKEL_CLIENT_CLI_JOB_CALLS_H_
#define BCCSKEL_CLIENT_CLI_JOB_CALLS_H_

#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/console.h"
#include "client/durable_client.h"
#include "core/volume/volume.h"

// Shared by the commands for jobs.

namespace bccskel::cli {

// Errors: those of EndpointOf() and CheckEndpoint().
absl::StatusOr<std::unique_ptr<client::DurableClient>> ClientOf(
    const ServerArguments& server, const client::RetryPolicy& policy = {});
// The same for waiting for a job, after the server has confirmed that it keeps the job.
absl::StatusOr<std::unique_ptr<client::DurableClient>> PatientClientOf(
    const JobArguments& arguments, const std::stop_token& stop);

// Options of calls that do not wait for a job.
client::DurableClient::Calls ShortCalls(const std::stop_token& stop);

// "2026-11-21T20:20:46Z"
std::string TimeText(client::Time time);
// One JSON object on one line, without a line end.
std::string JobJson(const client::DurableJob& job);
// "jobs/... succeeded", or the JSON object.
std::string JobSummary(const CommonArguments& common, const client::DurableJob& job);

// Waits for the job's end. A stop request cancels the job unless `waiting` says otherwise.
// Errors: those of DurableClient::Await().
absl::Status AwaitJob(client::DurableClient& client, const std::string& job,
                      const WaitingArguments& waiting, const std::stop_token& stop);

// Sends the object, creates a durable job for it and prints the job's name.
ExitCode SubmitDetached(const SkeletonizeArguments& arguments, const Volume& object,
                        const std::stop_token& stop);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_JOB_CALLS_H_
