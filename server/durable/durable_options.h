#ifndef BCCSKEL_SERVER_DURABLE_DURABLE_OPTIONS_H_
#define BCCSKEL_SERVER_DURABLE_DURABLE_OPTIONS_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "server/admission/tenant_limits.h"
#include "server/durable/records.h"

namespace bccskel::server {

struct DurableOptions {
  // Made where it does not exist. Empty: nothing is durable, and
  // there is no DurableJobs.
  std::string data_directory;
  // A PostgreSQL database, when several servers share it and the directory. Empty: a file of SQLite
  // in the directory, which is then this process's alone.
  std::string job_store;
  // A server of which nothing was heard for so long has lost its jobs to others.
  std::chrono::milliseconds lease = std::chrono::seconds(6);

  // Uploads count with their declared size. 0: no limit.
  uint64_t max_disk_bytes = 0;
  uint64_t max_tenant_disk_bytes = 0;

  std::chrono::seconds keep_uploads = std::chrono::hours(24);  // unfinished, since the last byte
  std::chrono::seconds keep_results = std::chrono::hours(24 * 7);  // and their jobs, since the end
  std::chrono::seconds keep_volumes = std::chrono::hours(24);      // since the last use
  // What no table names may be what a lost table named, so it stays for a while.
  std::chrono::seconds keep_unknown = std::chrono::hours(24);
  // Files that belong to another job store: "refuse" to start, or "adopt", go on without it.
  std::string unknown_data = "refuse";
  // A clock that leaps ahead further than this, while the server runs or since it last did, is not
  // believed for an hour: nothing expires.
  std::chrono::seconds believable_leap = std::chrono::hours(24);
  std::chrono::milliseconds clean_up_interval = std::chrono::minutes(1);

  int max_unfinished_jobs = 10'000;  // all tenants together
  int max_runs = 4;                  // at the runner at the same time, besides one-call jobs
  // Short jobs that are likely to have their turn so soon are claimed before there is a place.
  std::chrono::milliseconds soon{50};
  uint64_t max_job_bytes = 0;  // what the runner can ever admit; 0: unknown

  // Weights and caps as they are now. Called on DurableJobs' thread; must not block.
  std::function<TenantTable()> tenants = [] { return TenantTable(); };

  std::string algorithm_version;  // results of another one are not found again
  // Told of every state that a job comes into, once that is on disk. Called on DurableJobs'
  // thread; must not block.
  std::function<void(const JobRow& job)> on_job_state = [](const JobRow&) {};
  // Told of what somebody should look at. As on_job_state.
  std::function<void(const std::string& warning)> on_warning = [](const std::string&) {};
  std::function<Time()> now = [] { return std::chrono::system_clock::now(); };
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_DURABLE_OPTIONS_H_
