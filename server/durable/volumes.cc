#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"
#include "server/jobs/names.h"

namespace bccskel::server {

// An upload on its way to become a volume.
struct DurableJobs::Finishing {
  Session session;
  std::optional<Sha256Digest> expected;
  VolumeRow volume;
  bool new_blob = true;        // nothing had these bytes before
  std::shared_ptr<Run> along;  // that has decoded all of it
  std::optional<Step> step;    // of the job that waits for it
  Done<VolumeInfo> done;
};

void DurableJobs::FinishUpload(const std::string& tenant, const std::string& upload,
                               uint64_t size_bytes, std::optional<Sha256Digest> sha256,
                               Done<VolumeInfo> done) {
  done = Track(std::move(done));
  const Session session = uploads_.Find(tenant, upload);
  if (session == nullptr) {
    return WithSession(tenant, upload,
                       [this, tenant, upload, size_bytes, sha256,
                        done = std::move(done)](const absl::StatusOr<Session>& found) {
                         if (found.ok())
                           return FinishUpload(tenant, upload, size_bytes, sha256, done);
                         if (!absl::IsFailedPrecondition(found.status()))
                           return done(found.status());
                         FinishAgain(tenant, upload, done);
                       });
  }
  absl::Status status = session->BeginFinish(size_bytes);
  if (!status.ok()) return Answer<VolumeInfo>(std::move(done), std::move(status));
  const auto finishing = std::make_shared<Finishing>();
  finishing->session = session;
  finishing->expected = sha256;
  finishing->done = std::move(done);
  files_.Post({.tenant = tenant}, [this, finishing] { Seal(finishing); });
}

void DurableJobs::FinishAgain(const std::string& tenant, const std::string& upload,
                              Done<VolumeInfo> done) {
  Read<VolumeInfo>(
      [this, tenant, upload](JobStore& store) -> absl::StatusOr<VolumeInfo> {
        BCCSKEL_ASSIGN_OR_RETURN(const UploadRow row, store.Get<UploadRow>(tenant, upload));
        BCCSKEL_ASSIGN_OR_RETURN(const VolumeRow volume, store.Get<VolumeRow>(tenant, row.volume));
        return InfoOf(volume);
      },
      std::move(done));
}

void DurableJobs::Seal(const std::shared_ptr<Finishing>& finishing) {
  UploadSession& session = *finishing->session;
  const absl::StatusOr<Sha256Digest> digest = session.file().Seal();
  if (!digest.ok()) {
    session.EndWriting(Now());
    if (shared_ && absl::IsNotFound(digest.status())) {
      return finishing->done(Superseded(finishing->session));
    }
    return finishing->done(digest.status());
  }
  if (finishing->expected.has_value() && *finishing->expected != *digest) {
    const absl::Status error =
        InvalidVolume(absl::StrCat("the received bytes have the SHA-256 digest ", digest->Hex(),
                                   ", the request states ", finishing->expected->Hex()));
    return EndUpload(session.row().tenant, session.row().name, JobState::kFailed, error,
                     [finishing, error](const absl::Status&) { finishing->done(error); });
  }
  const UploadRow& row = session.row();
  finishing->volume = {.tenant = row.tenant,
                       .name = VolumeName(row.declaration, digest->Hex()),
                       .declaration = row.declaration,
                       .blob_digest = digest->Hex(),
                       .volume_digest = {},
                       .size_bytes = row.size_bytes,
                       .created = Now(),
                       .used = Now()};
  finishing->along = session.TakeAlong();
  loop_.Post(
      [this, finishing](JobStore& store) { return StoreVolume(store, *finishing); },
      [this, finishing](absl::Status status) { VolumeStored(*finishing, std::move(status)); });
}

absl::Status DurableJobs::StoreVolume(JobStore& store, Finishing& finishing) {
  VolumeRow& volume = finishing.volume;
  finishing.new_blob = true;
  finishing.step.reset();
  BCCSKEL_ASSIGN_OR_RETURN(UploadRow upload,
                           store.Get<UploadRow>(volume.tenant, finishing.session->row().name));
  if (upload.file != finishing.session->row().file) return Superseded(finishing.session);
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<VolumeRow> others,
                           store.FindVolumesOf(volume.tenant, volume.blob_digest));
  for (const VolumeRow& other : others) {
    if (other.blob_digest == volume.blob_digest) finishing.new_blob = false;
    if (other.name != volume.name) continue;
    volume.volume_digest = other.volume_digest;
    volume.created = other.created;
  }
  BCCSKEL_RETURN_IF_ERROR(blobs_.PublishBlob(upload, volume.blob_digest));
  BCCSKEL_RETURN_IF_ERROR(store.PutVolume(volume));
  upload.volume = volume.name;
  upload.used = volume.used;
  BCCSKEL_RETURN_IF_ERROR(store.UpdateUpload(upload));
  BCCSKEL_RETURN_IF_ERROR(store.InsertRemoval(RemovalOf(upload)));
  return upload.job.empty() ? absl::OkStatus() : StoreVolumeOfJob(store, finishing);
}

absl::Status DurableJobs::StoreVolumeOfJob(JobStore& store, Finishing& finishing) {
  const UploadRow& upload = finishing.session->row();
  BCCSKEL_ASSIGN_OR_RETURN(std::optional<JobRow> job,
                           store.Find<JobRow>(upload.tenant, upload.job));
  if (!job.has_value() || job->state != JobState::kReceiving) return absl::OkStatus();
  job->volume = finishing.volume.name;
  bool runs = active_.FindRun(finishing.along.get()) != nullptr;
  if (shared_ && runs) {
    BCCSKEL_ASSIGN_OR_RETURN(
        const bool elsewhere,
        store.RunsElsewhere(*job, finishing.volume.volume_digest, journal_.owner()));
    runs = !elsewhere;
  }
  BCCSKEL_ASSIGN_OR_RETURN(
      const auto event, journal_.Enter(store, *job, runs ? JobState::kRunning : JobState::kQueued));
  finishing.step = Step{.job = *job, .event = event};
  return absl::OkStatus();
}

void DurableJobs::VolumeStored(Finishing& finishing, absl::Status status) {
  UploadSession& session = *finishing.session;
  if (!status.ok()) {
    session.set_along(finishing.along);
    session.EndWriting(Now());
    return finishing.done(std::move(status));
  }
  DropSession(session.row());
  if (!finishing.new_blob) quota_.GiveBack(session.row().tenant, session.row().size_bytes);
  if (finishing.step.has_value()) Apply(*finishing.step);
  ActiveRun* const run = active_.FindRun(finishing.along.get());
  const bool waits = finishing.step.has_value() && finishing.step->job.state == JobState::kQueued;
  if (run != nullptr && !waits) {
    run->volume = finishing.volume.name;
    finishing.along->FinishVolume();
  } else if (finishing.step.has_value() && finishing.step->job.state == JobState::kRunning) {
    // The run has ended while this was stored.
    EnterState({finishing.step->job.number}, JobState::kQueued, absl::OkStatus(), 0, nullptr);
  }
  finishing.done(InfoOf(finishing.volume));
  Schedule();
}

VolumeInfo DurableJobs::InfoOf(const VolumeRow& row) const {
  return {row, row.used + options_.keep_volumes};
}

void DurableJobs::FindVolumes(const std::string& tenant, const std::vector<std::string>& digests,
                              Done<std::vector<VolumeInfo>> done) {
  Read<std::vector<VolumeInfo>>(
      [this, tenant, digests](JobStore& store) -> absl::StatusOr<std::vector<VolumeInfo>> {
        std::vector<VolumeInfo> found;
        for (const std::string& digest : digests) {
          if (digest.empty()) continue;
          BCCSKEL_ASSIGN_OR_RETURN(std::vector<VolumeRow> rows,
                                   store.FindVolumesOf(tenant, digest));
          for (VolumeRow& row : rows) {
            if (!blobs_.HasBlob(row.tenant, row.blob_digest, row.size_bytes)) continue;
            row.used = Now();
            BCCSKEL_RETURN_IF_ERROR(store.PutVolume(row));
            found.push_back(InfoOf(row));
          }
        }
        return found;
      },
      std::move(done));
}

void DurableJobs::DeleteVolume(const std::string& tenant, const std::string& volume,
                               DoneStatus done) {
  Erase(
      [this, tenant, volume](JobStore& store, Erased& erased) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const VolumeRow row, store.Get<VolumeRow>(tenant, volume));
        BCCSKEL_ASSIGN_OR_RETURN(const auto user, store.UserOfVolume(tenant, volume));
        if (!user.has_value()) return EraseVolume(store, row, erased);
        return CallError(Reason::kVolumeInUse,
                         absl::StrCat(*user, " still needs ", volume, ": cancel it first"),
                         {.key = "job", .value = *user});
      },
      Track(std::move(done)));
}

absl::Status DurableJobs::EraseVolume(JobStore& store, const VolumeRow& row, Erased& erased) {
  erased.traces = Erased::Traces::kErase;
  erased.blobs.push_back(row);  // unless another volume has the same bytes: seen at the end
  return store.DeleteVolume(row.tenant, row.name);
}

}  // namespace bccskel::server
