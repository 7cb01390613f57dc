#include <utility>

#include "core/exec/status_macros.h"
#include "server/durable/durable_ledger.h"

namespace bccskel::server {

void DurableLedger::CleanUp() {
  next_clean_up_ = Now() + options_.clean_up_interval;
  ExpireUploads();
  ExpireJobs();
  ExpireVolumes();
}

void DurableLedger::ExpireUploads() {
  const Time oldest = Now() - options_.keep_uploads;
  std::vector<UploadRow> expired;
  {
    std::lock_guard lock(sessions_mutex_);
    for (const auto& [key, session] : sessions_) {
      if (session->used() < oldest) expired.push_back(session->row());
    }
  }
  for (const UploadRow& row : expired) {
    EndUpload(row.tenant, row.name, JobState::kFailed,
              absl::DeadlineExceededError("its upload was not finished in time"),
              [token = operations_.Begin()](const absl::Status&) {});
  }
  loop_.Post(
      [oldest](JobStore& store) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const std::vector<UploadRow> uploads, store.AllUploads());
        for (const UploadRow& row : uploads) {
          if (row.volume.empty() || row.used >= oldest) continue;
          BCCSKEL_RETURN_IF_ERROR(store.DeleteUpload(row.tenant, row.name));
        }
        return absl::OkStatus();
      },
      nullptr);
}

void DurableLedger::ExpireJobs() {
  const Time oldest = Now() - options_.keep_results;
  const auto erased = std::make_shared<Erased>();
  loop_.Post(
      [this, oldest, erased](JobStore& store) -> absl::Status {
        *erased = {};
        BCCSKEL_ASSIGN_OR_RETURN(const std::vector<JobRow> jobs, store.JobsEndedBefore(oldest));
        for (const JobRow& job : jobs) BCCSKEL_RETURN_IF_ERROR(EraseJob(store, job, *erased));
        return absl::OkStatus();
      },
      [this, erased](const absl::Status& status) {
        if (status.ok()) Apply(*erased);
      });
}

void DurableLedger::ExpireVolumes() {
  const Time oldest = Now() - options_.keep_volumes;
  const auto erased = std::make_shared<Erased>();
  loop_.Post(
      [this, oldest, erased](JobStore& store) -> absl::Status {
        *erased = {};
        BCCSKEL_ASSIGN_OR_RETURN(const std::vector<VolumeRow> volumes, store.AllVolumes());
        for (const VolumeRow& row : volumes) {
          if (row.used >= oldest) continue;
          BCCSKEL_ASSIGN_OR_RETURN(const auto user, store.UserOfVolume(row.tenant, row.name));
          if (!user.has_value()) BCCSKEL_RETURN_IF_ERROR(EraseVolume(store, row, *erased));
        }
        return absl::OkStatus();
      },
      [this, erased](const absl::Status& status) {
        if (status.ok()) Apply(*erased);
      });
}

}  // namespace bccskel::server
