#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"
#include "server/jobs/names.h"

namespace bccskel::server {
namespace {

absl::Status CheckDigest(const std::string& received, const std::optional<Sha256Digest>& stated) {
  if (!stated.has_value() || stated->Hex() == received) return absl::OkStatus();
  return InvalidVolume(absl::StrCat("the received bytes have the SHA-256 digest ", received,
                                    ", the request states ", stated->Hex()));
}

}  // namespace

// The state of FinishUpload().
struct DurableJobs::Finishing {
  Session session;
  VolumeRow volume;
  bool new_blob = true;                     // no volume had these bytes before
  std::shared_ptr<Run> decoder;             // the run that has decoded the upload
  std::optional<Step> step = std::nullopt;  // of the job that waits for it
};

Flow DurableJobs::FinishUpload(std::string tenant, std::string upload, uint64_t size_bytes,
                               std::optional<Sha256Digest> sha256, Done<VolumeInfo> done) {
  Session session = uploads_.Find(tenant, upload);
  if (session == nullptr) {
    const absl::StatusOr<Session> found = co_await SessionOf(tenant, upload);
    if (absl::IsFailedPrecondition(found.status())) {
      const auto read = [&](JobStore& store) -> absl::StatusOr<VolumeInfo> {
        BCCSKEL_ASSIGN_OR_RETURN(const UploadRow row, store.Get<UploadRow>(tenant, upload));
        BCCSKEL_ASSIGN_OR_RETURN(const auto volume, store.Get<VolumeRow>(tenant, row.volume));
        BCCSKEL_RETURN_IF_ERROR(CheckDigest(volume.blob_digest, sha256));
        return InfoOf(volume);
      };
      co_return done(co_await Read<VolumeInfo>(read));  // finished before
    }
    if (!found.ok()) co_return done(found.status());
    session = *found;
  }
  absl::Status status = session->BeginFinish(size_bytes);
  co_await ToFiles(tenant);
  if (!status.ok()) co_return done(std::move(status));
  const absl::StatusOr<Sha256Digest> digest = session->file().Seal();
  if (!digest.ok()) {
    session->EndWriting(Now());
    co_return done(WriteError(session, digest.status()));
  }
  const absl::Status error = CheckDigest(digest->Hex(), sha256);
  if (!error.ok()) {
    co_return EndUpload(tenant, upload, JobState::kFailed, error,
                        [done, error](const absl::Status&) { done(error); });
  }
  Finishing finishing = {.session = session,
                         .volume = NewVolume(session->row(), digest->Hex()),
                         .decoder = session->DetachDecoder()};
  status = co_await Commit([&](JobStore& store) { return StoreVolume(store, finishing); });
  if (!status.ok()) {
    session->set_decoder(finishing.decoder);
    session->EndWriting(Now());
    co_return done(std::move(status));
  }
  VolumeStored(finishing);
  done(InfoOf(finishing.volume));
  Schedule();
}

VolumeRow DurableJobs::NewVolume(const UploadRow& row, const std::string& digest) const {
  const Time now = Now();
  return {.tenant = row.tenant,
          .name = VolumeName(row.declaration, digest),
          .declaration = row.declaration,
          .blob_digest = digest,
          .volume_digest = {},
          .size_bytes = row.size_bytes,
          .created = now,
          .used = now};
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
  BCCSKEL_RETURN_IF_ERROR(store.Put(volume));
  upload.volume = volume.name;
  upload.used = volume.used;
  BCCSKEL_RETURN_IF_ERROR(store.Put(upload));
  BCCSKEL_RETURN_IF_ERROR(
      store.Put(RemovalRow{RemovalRow::Kind::kUpload, upload.tenant, upload.file}));
  return upload.job.empty() ? absl::OkStatus() : StoreVolumeOfJob(store, finishing);
}

absl::Status DurableJobs::StoreVolumeOfJob(JobStore& store, Finishing& finishing) {
  const UploadRow& upload = finishing.session->row();
  BCCSKEL_ASSIGN_OR_RETURN(auto job, store.Find<JobRow>(upload.tenant, upload.job));
  if (!job.has_value() || job->state != JobState::kReceiving) return absl::OkStatus();
  job->volume = finishing.volume.name;
  bool runs = active_.FindRun(finishing.decoder.get()) != nullptr;
  if (shared_ && runs) {
    BCCSKEL_ASSIGN_OR_RETURN(
        const bool elsewhere,
        store.RunsElsewhere(*job, finishing.volume.volume_digest, journal_.owner()));
    runs = !elsewhere;
  }
  const JobState state = runs ? JobState::kRunning : JobState::kQueued;
  BCCSKEL_ASSIGN_OR_RETURN(finishing.step, journal_.Enter(store, *std::move(job), state));
  return absl::OkStatus();
}

void DurableJobs::VolumeStored(const Finishing& finishing) {
  const UploadRow& upload = finishing.session->row();
  DropSession(upload);
  if (!finishing.new_blob) quota_.GiveBack(upload.tenant, upload.size_bytes);
  if (finishing.step.has_value()) Apply(*finishing.step);
  ActiveRun* const run = active_.FindRun(finishing.decoder.get());
  const auto entered = [&finishing](JobState state) {
    return finishing.step.has_value() && finishing.step->job.state == state;
  };
  if (run != nullptr && !entered(JobState::kQueued)) {
    run->volume = finishing.volume.name;
    finishing.decoder->FinishVolume();
  } else if (entered(JobState::kRunning)) {
    // The run has ended in the meantime.
    EnterState({finishing.step->job.number}, JobState::kQueued);
  }
}

VolumeInfo DurableJobs::InfoOf(const VolumeRow& row) const {
  return {row, row.used + options_.keep_volumes};
}

Flow DurableJobs::FindVolumes(std::string tenant, std::vector<std::string> digests,
                              Done<std::vector<VolumeInfo>> done) {
  const auto read = [&](JobStore& store) -> absl::StatusOr<std::vector<VolumeInfo>> {
    std::vector<VolumeInfo> found;
    for (const std::string& digest : digests) {
      if (digest.empty()) continue;
      BCCSKEL_ASSIGN_OR_RETURN(std::vector<VolumeRow> rows, store.FindVolumesOf(tenant, digest));
      for (VolumeRow& row : rows) {
        if (!blobs_.HasBlob(row.tenant, row.blob_digest, row.size_bytes)) continue;
        row.used = Now();
        BCCSKEL_RETURN_IF_ERROR(store.Put(row));
        found.push_back(InfoOf(row));
      }
    }
    return found;
  };
  done(co_await Read<std::vector<VolumeInfo>>(read));
}

void DurableJobs::DeleteVolume(const std::string& tenant, const std::string& volume,
                               DoneStatus done) {
  Erase(
      [tenant, volume](JobStore& store, Erased& erased) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const VolumeRow row, store.Get<VolumeRow>(tenant, volume));
        BCCSKEL_ASSIGN_OR_RETURN(const auto user, store.UserOfVolume(tenant, volume));
        if (!user.has_value()) return EraseVolume(store, row, erased);
        return CallError(Reason::kVolumeInUse,
                         absl::StrCat(*user, " still needs ", volume, ": cancel it first"),
                         {.key = "job", .value = *user});
      },
      std::move(done));
}

absl::Status DurableJobs::EraseVolume(JobStore& store, const VolumeRow& row, Erased& erased) {
  erased.traces = Erased::Traces::kErase;
  erased.blobs.push_back(row);  // kept if another volume has the same bytes; checked later
  BCCSKEL_RETURN_IF_ERROR(
      store.Put(RemovalRow{RemovalRow::Kind::kBlob, row.tenant, row.blob_digest}));
  return store.DeleteVolume(row.tenant, row.name);
}

}  // namespace bccskel::server
