#include <vector>

#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"

namespace bccskel::server {

void DurableJobs::CleanUp() {
  next_clean_up_ = Now() + options_.clean_up_interval;
  loop_.Post([this](JobStore& store) { return folder_.RemoveDeleted(store); },
             [this](const absl::Status&) { loop_.store().Forget().IgnoreError(); },
             GroupCommit::Room::kReserve);
  if (!ClockIsTrusted()) return;
  SweepShared();
  ExpireUploads();
  ExpireJobs();
  ExpireVolumes();
}

bool DurableJobs::ClockIsTrusted() {
  const bool believed = clock_.Trusts(Now(), std::chrono::steady_clock::now());
  if (believed) folder_.Touch(Now());  // else the next start would believe this clock
  if (!believed) {
    options_.on_warning(
        "the clock has leapt ahead by more than a day: nothing expires for an hour");
  }
  return believed;
}

// Uploads of other servers are judged by their files.
std::vector<UploadRow> DurableJobs::UnusedUploads(Time oldest) {
  std::vector<UploadRow> unused;
  const auto uploads = loop_.store().All<UploadRow>();
  for (const UploadRow& row : uploads.ok() ? *uploads : std::vector<UploadRow>()) {
    if (row.volume.empty() && InfoOf(row).expires < oldest + options_.keep_uploads) {
      unused.push_back(row);
    }
  }
  return unused;
}

void DurableJobs::ExpireUploads() {
  const Time oldest = Now() - options_.keep_uploads;
  for (const UploadRow& row : UnusedUploads(oldest)) {
    EndUpload(row.tenant, row.name, JobState::kFailed,
              absl::DeadlineExceededError("its upload was not finished in time"));
  }
  loop_.Post(
      [oldest](JobStore& store) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const std::vector<UploadRow> uploads, store.All<UploadRow>());
        for (const UploadRow& row : uploads) {
          if (row.volume.empty() || row.used >= oldest) continue;
          BCCSKEL_RETURN_IF_ERROR(store.Delete<UploadRow>(row.tenant, row.name));
        }
        return absl::OkStatus();
      },
      nullptr, GroupCommit::Room::kReserve);
}

// A few at a time, so that the reserve of a full disk suffices.
void DurableJobs::ExpireJobs() {
  constexpr int kMostAtATime = 100;
  const Time oldest = Now() - options_.keep_results;
  const auto more = std::make_shared<bool>(false);
  Erase(
      [this, oldest, more](JobStore& store, Erased& erased) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const std::vector<JobRow> jobs,
                                 store.JobsEndedBefore(oldest, kMostAtATime));
        for (const JobRow& job : jobs) BCCSKEL_RETURN_IF_ERROR(EraseJob(store, job, erased));
        *more = jobs.size() == kMostAtATime;
        return absl::OkStatus();
      },
      [this, more](const absl::Status& status) {
        if (status.ok() && *more && !stopping_) ExpireJobs();
      });
}

void DurableJobs::ExpireVolumes() {
  const Time oldest = Now() - options_.keep_volumes;
  Erase([oldest](JobStore& store, Erased& erased) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<VolumeRow> volumes, store.All<VolumeRow>());
    for (const VolumeRow& row : volumes) {
      if (row.used >= oldest) continue;
      BCCSKEL_ASSIGN_OR_RETURN(const auto user, store.UserOfVolume(row.tenant, row.name));
      if (!user.has_value()) BCCSKEL_RETURN_IF_ERROR(EraseVolume(store, row, erased));
    }
    return absl::OkStatus();
  });
}

}  // namespace bccskel::server
