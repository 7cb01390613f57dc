#include <ctime>

#include "absl/time/time.h"
#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/job_calls.h"
#include "client/cli/json_text.h"
#include "client/export/text.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
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

std::string Padded(std::string text, size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string Table(const std::vector<DurableJob>& jobs) {
  exporting::Text text;
  text.Add(Padded("JOB", 40), Padded("STATE", 11), Padded("CREATED", 22), "MESSAGE\n");
  for (const DurableJob& job : jobs) {
    text.Add(Padded(job.name, 39), " ", Padded(NameOf(job.state), 10), " ",
             Padded(TimeText(job.created), 21), " ", std::string(job.error.message()), "\n");
  }
  return std::move(text).Take();
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
