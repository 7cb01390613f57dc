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

// What the commands for jobs share.

namespace bccskel::cli {

// Errors: those of EndpointOf() and CheckEndpoint().
absl::StatusOr<std::unique_ptr<client::DurableClient>> ClientOf(
    const ServerArguments& server, const client::RetryPolicy& policy = {});
// The same for waiting on a job, once the server has said that it keeps the job.
absl::StatusOr<std::unique_ptr<client::DurableClient>> PatientClientOf(
    const JobArguments& arguments, const std::stop_token& stop);

// Calls that do not wait for a job.
client::DurableClient::Calls ShortCalls(const std::stop_token& stop);

// "2026-11-21T20:20:46Z"
std::string TimeText(client::Time time);
// One JSON object on one line, without a line end.
std::string JobJson(const client::DurableJob& job);
// "jobs/... succeeded", or the JSON object.
std::string JobSummary(const CommonArguments& common, const client::DurableJob& job);

// Waits for the job's end. A stop cancels the job unless it is to continue.
// Errors: those of DurableClient::Watch(); what made the job fail; CANCELLED.
absl::Status AwaitJob(client::DurableClient& client, const std::string& job,
                      const WaitingArguments& waiting, const std::stop_token& stop);

// Sends the object, makes a job of it that the server keeps, and prints the job's name.
ExitCode SubmitDetached(const SkeletonizeArguments& arguments, const Volume& object,
                        const std::stop_token& stop);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_JOB_CALLS_H_
