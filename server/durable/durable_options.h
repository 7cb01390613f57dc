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
  // Created if missing. Empty: nothing is durable, and there is no DurableJobs.
  std::string data_directory;
  // A PostgreSQL database if several servers share it and the directory. Empty: an SQLite file in
  // the directory, which this process then owns alone.
  std::string job_store;
  // A server that is silent for this long loses its jobs to others.
  std::chrono::milliseconds lease = std::chrono::seconds(6);

  // Uploads count with their declared size. 0: no limit.
  uint64_t max_disk_bytes = 0;
  uint64_t max_tenant_disk_bytes = 0;

  std::chrono::seconds keep_uploads = std::chrono::hours(24);  // unfinished, since the last byte
  std::chrono::seconds keep_results = std::chrono::hours(24 * 7);  // and their jobs, since the end
  std::chrono::seconds keep_volumes = std::chrono::hours(24);      // since the last use
  // Files that no table names stay for this long: a lost table may have named them.
  std::chrono::seconds keep_unknown = std::chrono::hours(24);
  // For files of another job store: "refuse" to start, or "adopt", continue without them.
  std::string unknown_data = "refuse";
  // After the clock leaps ahead by more than this, while the server runs or since it last did,
  // nothing expires for an hour.
  std::chrono::seconds max_clock_leap = std::chrono::hours(24);
  std::chrono::milliseconds clean_up_interval = std::chrono::minutes(1);

  int max_unfinished_jobs = 10'000;  // all tenants together
  int max_runs = 4;                  // at the runner at the same time, besides jobs in memory
  // Short jobs likely to start within this time are claimed before a place is free.
  std::chrono::milliseconds soon{50};
  uint64_t max_job_bytes = 0;  // the most that the runner can ever admit; 0: unknown

  // The current weights and caps. Called on DurableJobs' thread; must not block.
  std::function<TenantTable()> tenants = [] { return TenantTable(); };

  std::string algorithm_version;  // results of other versions are not reused
  // Called for every state that a job enters, once that is on disk, on DurableJobs' thread; must
  // not block.
  std::function<void(const JobRow& job)> on_job_state = [](const JobRow&) {};
  // Called with what an operator should know, as on_job_state.
  std::function<void(const std::string& warning)> on_warning = [](const std::string&) {};
  std::function<Time()> now = [] { return std::chrono::system_clock::now(); };
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_DURABLE_OPTIONS_H_
