#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/digest/random_id.h"
#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"
#include "server/jobs/names.h"
#include "server/jobs/volume_receiver.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// The state of CreateUpload().
struct DurableJobs::Opening {
  UploadRow row;
  std::optional<JobRow> job;
  std::optional<JobRequest> request;  // of that job
  std::shared_ptr<Run> run;           // decodes the upload as it arrives
  std::optional<Step> step;           // of the job
  bool counted = false;               // by the quota
  std::optional<UploadRow> existing;  // the existing equal upload
};

void DurableJobs::DropSession(const UploadRow& row) {
  uploads_.Remove(row);
  // If this fails, the next start sweeps it.
  UploadFile::Remove(blobs_.PathOf(row)).IgnoreError();
}

Flow DurableJobs::CreateUpload(std::string tenant, NewUpload upload, Done<UploadInfo> done) {
  Opening opening;
  opening.row.tenant = tenant;
  opening.row.name = upload.name.empty() ? RandomName("uploads") : upload.name;
  opening.row.declaration = upload.declaration;
  opening.row.used = Now();
  opening.row.file = RandomId();
  absl::Status status = PrepareUpload(upload, opening);
  if (status.ok()) {
    status = co_await Commit([&](JobStore& store) { return StoreUpload(store, opening); });
    if (!status.ok()) GiveUp(opening);
    if (status.ok() && opening.existing.has_value()) co_return done(InfoOf(*opening.existing));
    if (status.ok() && opening.step.has_value()) {
      Apply(*opening.step);
      const JobRow& job = opening.step->job;
      active_.Attach(active_.AddRun(opening.run, job, ActiveRun::Source::kUpload), job.number);
    }
  }
  co_await ToFiles(tenant);
  if (!status.ok()) co_return done(std::move(status));
  auto file = UploadFile::Open(blobs_.PathOf(opening.row));
  if (!file.ok()) {
    co_return EndUpload(tenant, opening.row.name, JobState::kFailed, file.status(),
                        [done, error = file.status()](const absl::Status&) { done(error); });
  }
  const auto session = std::make_shared<UploadSession>(opening.row, *std::move(file), Now());
  session->set_decoder(opening.run);
  uploads_.Add(session);
  done(InfoOf(opening.row));
}

absl::Status DurableJobs::PrepareUpload(const NewUpload& upload, Opening& opening) {
  BCCSKEL_RETURN_IF_ERROR(CheckAdmitting());
  BCCSKEL_RETURN_IF_ERROR(CheckUploadName(opening.row.name));
  const std::string options = upload.then_job.has_value() ? upload.then_job->options : "";
  BCCSKEL_ASSIGN_OR_RETURN(JobRequest request, codec_.RequestOf(upload.declaration, options));
  opening.row.size_bytes = request.size_bytes;
  if (!upload.then_job.has_value()) return absl::OkStatus();
  BCCSKEL_RETURN_IF_ERROR(CheckFits(request));
  JobRow& job = opening.job.emplace();
  job.tenant = opening.row.tenant;
  job.name = RandomName("jobs");
  job.upload = opening.row.name;
  job.options = codec_.OptionsFor(request, options);
  job.priority = upload.then_job->priority;
  job.threads = upload.then_job->threads;
  job.trace = upload.then_job->trace;
  job.state = JobState::kReceiving;
  opening.row.job = opening.job->name;
  opening.request = RunnerRequest(std::move(request), *opening.job);
  return absl::OkStatus();
}

absl::Status DurableJobs::StoreUpload(JobStore& store, Opening& opening) {
  BCCSKEL_ASSIGN_OR_RETURN(opening.existing,
                           store.Find<UploadRow>(opening.row.tenant, opening.row.name));
  if (opening.existing.has_value()) return CheckSameUpload(store, opening);
  if (shared_ && (options_.max_disk_bytes > 0 || options_.max_tenant_disk_bytes > 0)) {
    BCCSKEL_RETURN_IF_ERROR(CountFiles(store));
    opening.counted = false;
  }
  if (!opening.counted) {
    BCCSKEL_RETURN_IF_ERROR(quota_.Take(opening.row.tenant, opening.row.size_bytes));
    opening.counted = true;
  }
  BCCSKEL_RETURN_IF_ERROR(store.Insert(opening.row));
  uploads_.BeginOpening(opening.row);
  return opening.job.has_value() ? StoreReceivingJob(store, opening) : absl::OkStatus();
}

absl::Status DurableJobs::CheckSameUpload(JobStore& store, const Opening& opening) const {
  const UploadRow& found = *opening.existing;
  bool same =
      found.declaration == opening.row.declaration && found.job.empty() == opening.row.job.empty();
  if (same && opening.job.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto job, store.Find<JobRow>(found.tenant, found.job));
    same = job.has_value() && job->options == opening.job->options;
  }
  if (same) return absl::OkStatus();
  return CallError(Reason::kUploadExists,
                   absl::StrCat(found.name, " was started with another declaration or job"));
}

absl::Status DurableJobs::StoreReceivingJob(JobStore& store, Opening& opening) {
  BCCSKEL_RETURN_IF_ERROR(CheckRoomForJob(opening.row.tenant));
  BCCSKEL_ASSIGN_OR_RETURN(opening.step, journal_.Insert(store, *opening.job));
  if (opening.run != nullptr) return absl::OkStatus();
  opening.run = std::make_shared<Run>(*this, opening.row.tenant, BeginOperation());
  absl::Status started = opening.run->Start(runner_, *std::move(opening.request));
  if (!started.ok()) opening.run = nullptr;
  return started;
}

void DurableJobs::GiveUp(const Opening& opening) {
  uploads_.EndOpening(opening.row);
  if (opening.counted) quota_.GiveBack(opening.row.tenant, opening.row.size_bytes);
  if (opening.run != nullptr) opening.run->Cancel();
}

Flow DurableJobs::Append(std::string tenant, std::string upload, uint64_t offset, std::string bytes,
                         std::optional<uint32_t> crc32c, Done<uint64_t> done) {
  Session session = uploads_.Find(tenant, upload);
  if (session == nullptr) {
    const absl::StatusOr<Session> found = co_await SessionOf(tenant, upload);
    if (!found.ok()) co_return done(found.status());
    session = *found;
  }
  absl::Status status = session->BeginAppend(offset, bytes.size());
  co_await ToFiles(tenant);
  if (!status.ok()) co_return done(std::move(status));
  status = CheckChunk(bytes, crc32c);
  if (status.ok()) status = session->file().Append(bytes);
  if (!status.ok()) status = WriteError(session, status);
  const std::shared_ptr<Run> decoder = status.ok() ? session->decoder() : nullptr;
  if (decoder != nullptr) {
    const absl::Status decoded = co_await Await<absl::Status>(
        [&](auto resume) { decoder->Append(std::move(bytes), resume); });
    // Any other end of the decoding does not matter: the bytes are stored.
    if (absl::IsInvalidArgument(decoded)) status = InvalidVolume(std::string(decoded.message()));
  }
  session->EndWriting(Now());
  if (!status.ok()) co_return done(std::move(status));
  done(session->committed());
}

absl::Status DurableJobs::WriteError(const Session& session, const absl::Status& error) {
  if (!IsMissingFile(error)) return error;
  if (shared_) return Superseded(session);
  return absl::NotFoundError(absl::StrCat("there is no upload ", session->row().name));
}

void DurableJobs::SenderGone(const std::string& tenant, const std::string& upload) {
  const Session session = uploads_.Find(tenant, upload);
  if (session == nullptr) return;
  const std::shared_ptr<Run> decoder = session->DetachDecoder();
  if (decoder == nullptr) return;
  decoder->Cancel();
}

Flow DurableJobs::GetUpload(std::string tenant, std::string upload, Done<UploadInfo> done) {
  const auto read = [&](JobStore& store) -> absl::StatusOr<UploadInfo> {
    BCCSKEL_ASSIGN_OR_RETURN(const UploadRow row, store.Get<UploadRow>(tenant, upload));
    // Drop a session that another server has taken over, so that the caller can resume here.
    const Session session = uploads_.Find(tenant, upload);
    if (session != nullptr && session->row().file != row.file) uploads_.Remove(session);
    return InfoOf(row);
  };
  done(co_await Read<UploadInfo>(read));
}

void DurableJobs::DeleteUpload(const std::string& tenant, const std::string& upload,
                               DoneStatus done) {
  EndUpload(tenant, upload, JobState::kCancelled, absl::OkStatus(), std::move(done));
}

void DurableJobs::EndUpload(const std::string& tenant, const std::string& upload, JobState state,
                            const absl::Status& error, DoneStatus done) {
  Erase(
      [this, tenant, upload, state, error](JobStore& store, Erased& erased) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const UploadRow row, store.Get<UploadRow>(tenant, upload));
        return EraseUpload(store, row, state, error, erased);
      },
      std::move(done));
}

absl::Status DurableJobs::EraseUpload(JobStore& store, const UploadRow& row, JobState state,
                                      const absl::Status& error, Erased& erased) {
  BCCSKEL_RETURN_IF_ERROR(store.Delete<UploadRow>(row.tenant, row.name));
  erased.traces = Erased::Traces::kErase;
  if (!row.volume.empty()) return absl::OkStatus();
  erased.uploads.push_back(row);
  BCCSKEL_RETURN_IF_ERROR(store.Put(RemovalRow{RemovalRow::Kind::kUpload, row.tenant, row.file}));
  if (row.job.empty()) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const auto job, store.Find<JobRow>(row.tenant, row.job));
  if (!job.has_value() || IsTerminal(job->state)) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(erased.steps.emplace_back(), journal_.Enter(store, *job, state, error));
  return absl::OkStatus();
}

UploadInfo DurableJobs::InfoOf(const UploadRow& row) const {
  Session session = uploads_.Find(row.tenant, row.name);
  if (session != nullptr && session->row().file != row.file) session = nullptr;
  UploadInfo info{row, row.volume.empty() ? 0 : row.size_bytes, row.used + options_.keep_uploads};
  if (session != nullptr && row.volume.empty()) {
    info.committed_bytes = session->committed();
    info.expires = session->used() + options_.keep_uploads;
  } else if (shared_ && row.volume.empty()) {
    info.committed_bytes = UploadFile::SizeOf(blobs_.PathOf(row));
    const auto facts = FactsOf(UploadFile::BytesPath(blobs_.PathOf(row)));
    if (facts.ok()) info.expires = std::max(row.used, facts->written) + options_.keep_uploads;
  }
  return info;
}

}  // namespace bccskel::server
