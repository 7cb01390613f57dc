#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"
#include "server/jobs/names.h"

namespace bccskel::server {
namespace {

constexpr int kMostPerPage = 1000;
constexpr uint32_t kAllStates = 0x3F;

uint32_t BitsOf(const std::vector<JobState>& states) {
  uint32_t bits = 0;
  for (const JobState state : states) bits |= uint32_t{1} << static_cast<int>(state);
  return states.empty() ? kAllStates : bits;
}

// The page token after this job. It holds only what the tenant knows of that job: it reveals
// nothing about other tenants, and stays valid when the job is deleted.
std::string TokenOf(const JobPosition& last, uint32_t states) {
  return absl::WebSafeBase64Escape(
      absl::StrCat(last.created.time_since_epoch().count(), " ", last.name, " ", states));
}

absl::StatusOr<std::optional<JobPosition>> PositionOf(const std::string& token, uint32_t states) {
  if (token.empty()) return std::nullopt;
  std::string text;
  absl::WebSafeBase64Unescape(token, &text);
  const std::vector<std::string> parts = absl::StrSplit(text, ' ');
  int64_t created = 0;
  if (parts.size() == 3 && absl::SimpleAtoi(parts[0], &created)) {
    const JobPosition position = {.created = Time(Time::duration(created)), .name = parts[1]};
    if (TokenOf(position, states) == token) return position;
  }
  return InvalidField("page_token", "did not come with a page of these states");
}

// Identifies equal requests.
std::string BodyOf(const NewJob& job) {
  return KeyOf({job.volume, job.options, absl::StrCat(job.priority), absl::StrCat(job.threads)});
}

// Also accepts a repeat that states the options as the server returned them.
bool IsSameRequest(const JobRow& found, const NewJob& wanted) {
  if (found.body == BodyOf(wanted)) return true;
  return found.volume == wanted.volume && found.options == wanted.options &&
         found.priority == wanted.priority && found.threads == wanted.threads;
}

}  // namespace

// The state of CreateJob().
struct DurableJobs::Creating {
  std::string tenant;
  NewJob wanted;
  VolumeRow volume = {};
  std::string options = {};     // canonical for the volume
  std::string unread_key = {};  // key of a stored result that must be checked first
  bool looked = false;          // that check was made
  std::optional<ResultRow> whole = std::nullopt;  // the checked result
  std::optional<Step> step = std::nullopt;        // of a new job
  JobInfo info = {};
};

JobInfo DurableJobs::PlainInfoOf(const JobRow& row) const {
  JobInfo info;
  static_cast<JobRow&>(info) = row;
  if (row.ended.has_value()) info.expires = *row.ended + options_.keep_results;
  return info;
}

absl::StatusOr<JobInfo> DurableJobs::InfoOf(JobStore& store, const JobRow& row) const {
  JobInfo info = PlainInfoOf(row);
  if (row.state == JobState::kRunning) info.progress = watches_.ProgressOf(row.number);
  if (const auto event = ProgressElsewhere(store, row); event.has_value()) {
    info.progress = std::get<JobProgress>(event->what);
  }
  if (row.result == 0) return info;
  BCCSKEL_ASSIGN_OR_RETURN(const std::optional<ResultRow> result, store.FindResult(row.result));
  if (!result.has_value()) return info;
  info.result_records = result->records;
  info.result_bytes = result->bytes;
  info.summary = result->summary;
  return info;
}

Flow DurableJobs::CreateJob(std::string tenant, NewJob job, Done<JobInfo> done) {
  Creating creating = {.tenant = std::move(tenant), .wanted = std::move(job)};
  const auto store_job = [&](JobStore& store) { return StoreJob(store, creating); };
  absl::Status status = co_await Commit(store_job);
  if (status.ok() && !creating.unread_key.empty()) {
    creating.whole = co_await WholeResult(creating.tenant, creating.unread_key);
    creating.looked = true;
    status = co_await Commit(store_job);
  }
  if (!status.ok()) co_return done(std::move(status));
  if (creating.step.has_value()) {
    Apply(*creating.step);
    if (IsTerminal(creating.step->job.state)) ++cached_;
  }
  done(std::move(creating.info));
  Schedule();
}

absl::Status DurableJobs::StoreJob(JobStore& store, Creating& creating) {
  const NewJob& wanted = creating.wanted;
  creating.step.reset();
  creating.unread_key.clear();
  BCCSKEL_RETURN_IF_ERROR(CheckAdmitting());
  BCCSKEL_ASSIGN_OR_RETURN(const std::optional<JobRow> found,
                           store.FindJobOfRequest(creating.tenant, wanted.request_id));
  if (found.has_value()) {
    if (!IsSameRequest(*found, wanted)) {
      return CallError(Reason::kRequestIdReused,
                       absl::StrCat("request_id ", wanted.request_id, " has created ", found->name,
                                    ", a different job"),
                       {.key = "job", .value = found->name});
    }
    BCCSKEL_ASSIGN_OR_RETURN(creating.info, InfoOf(store, *found));
    return absl::OkStatus();
  }
  BCCSKEL_RETURN_IF_ERROR(CheckJob(store, creating));
  JobRow job;
  job.tenant = creating.tenant;
  job.request_id = wanted.request_id;
  job.body = BodyOf(wanted);
  job.options = creating.options;
  job.priority = wanted.priority;
  job.threads = wanted.threads;
  job.trace = wanted.trace;
  job.volume = wanted.volume;
  if (wanted.mode == NewJob::Mode::kValidateOnly) {
    creating.info = PlainInfoOf(job);
    return absl::OkStatus();
  }
  job.name = RandomName("jobs");
  return InsertJob(store, std::move(job), creating);
}

absl::Status DurableJobs::CheckJob(JobStore& store, Creating& creating) {
  const absl::StatusOr<VolumeRow> volume =
      store.Get<VolumeRow>(creating.tenant, creating.wanted.volume);
  if (absl::IsNotFound(volume.status())) {
    return CallError(Reason::kVolumeMissing, std::string(volume.status().message()));
  }
  BCCSKEL_RETURN_IF_ERROR(volume.status());
  if (!blobs_.HasBlob(volume->tenant, volume->blob_digest, volume->size_bytes)) {
    return CallError(Reason::kVolumeMissing,
                     absl::StrCat("the bytes of ", volume->name, " are lost: send them again"));
  }
  creating.volume = *volume;
  BCCSKEL_ASSIGN_OR_RETURN(const JobRequest request,
                           codec_.RequestOf(volume->declaration, creating.wanted.options));
  creating.options = codec_.OptionsFor(request, creating.wanted.options);
  BCCSKEL_RETURN_IF_ERROR(CheckFits(request));
  return CheckRoomForJob(creating.tenant);
}

absl::Status DurableJobs::InsertJob(JobStore& store, JobRow job, Creating& creating) {
  VolumeRow& volume = creating.volume;
  volume.used = Now();
  BCCSKEL_RETURN_IF_ERROR(store.Put(volume));
  if (!volume.volume_digest.empty()) {
    const std::string key = ResultKey(volume.volume_digest, job.options);
    BCCSKEL_ASSIGN_OR_RETURN(const auto result, store.FindResultOf(job.tenant, key));
    if (result.has_value()) {
      const bool whole = creating.whole.has_value() && creating.whole->file == result->file;
      if (!whole && !creating.looked) {
        creating.unread_key = key;
        return absl::OkStatus();
      }
      if (whole) job.state = JobState::kSucceeded;
      if (whole) job.result = result->number;
    }
  }
  BCCSKEL_ASSIGN_OR_RETURN(creating.step, journal_.Insert(store, std::move(job)));
  BCCSKEL_ASSIGN_OR_RETURN(creating.info, InfoOf(store, creating.step->job));
  return absl::OkStatus();
}

Flow DurableJobs::GetJob(std::string tenant, std::string job, Done<JobInfo> done) {
  const auto read = [&](JobStore& store) -> absl::StatusOr<JobInfo> {
    BCCSKEL_ASSIGN_OR_RETURN(const JobRow row, store.Get<JobRow>(tenant, job));
    return InfoOf(store, row);
  };
  done(co_await Read<JobInfo>(read));
}

Flow DurableJobs::ListJobs(std::string tenant, JobQuery query, Done<JobPage> done) {
  const auto read = [&](JobStore& store) -> absl::StatusOr<JobPage> {
    const int size = std::clamp(query.page_size, 1, kMostPerPage);
    const uint32_t states = BitsOf(query.states);
    BCCSKEL_ASSIGN_OR_RETURN(const auto after, PositionOf(query.page_token, states));
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<JobRow> rows,
                             store.ListJobs(tenant, after, states, size + 1));
    JobPage page;
    for (const JobRow& row : rows) {
      if (page.jobs.size() == static_cast<size_t>(size)) break;
      page.next_token = TokenOf({.created = row.created, .name = row.name}, states);
      BCCSKEL_ASSIGN_OR_RETURN(JobInfo info, InfoOf(store, row));
      info.summary.clear();
      info.progress.reset();
      page.jobs.push_back(std::move(info));
    }
    if (rows.size() <= static_cast<size_t>(size)) page.next_token.clear();
    return page;
  };
  done(co_await Read<JobPage>(read));
}

Flow DurableJobs::CancelJob(std::string tenant, std::string job, Done<JobInfo> done) {
  JobInfo info;
  const auto cancel = [&](JobStore& store, Erased& erased) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(const JobRow row, store.Get<JobRow>(tenant, job));
    BCCSKEL_RETURN_IF_ERROR(CancelIfUnfinished(store, row, erased));
    BCCSKEL_ASSIGN_OR_RETURN(const JobRow now, store.Get<JobRow>(tenant, job));
    BCCSKEL_ASSIGN_OR_RETURN(info, InfoOf(store, now));
    return absl::OkStatus();
  };
  absl::Status status = co_await Await<absl::Status>([&](auto resume) { Erase(cancel, resume); });
  if (!status.ok()) co_return done(std::move(status));
  done(std::move(info));
}

absl::Status DurableJobs::CancelIfUnfinished(JobStore& store, const JobRow& job, Erased& erased) {
  if (IsTerminal(job.state)) return absl::OkStatus();
  if (job.state == JobState::kReceiving) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto upload, store.Find<UploadRow>(job.tenant, job.upload));
    if (upload.has_value()) {
      return EraseUpload(store, *upload, JobState::kCancelled, absl::OkStatus(), erased);
    }
  }
  BCCSKEL_ASSIGN_OR_RETURN(erased.steps.emplace_back(),
                           journal_.Enter(store, job, JobState::kCancelled));
  return absl::OkStatus();
}

void DurableJobs::DeleteJob(const std::string& tenant, const std::string& job, DoneStatus done) {
  Erase(
      [this, tenant, job](JobStore& store, Erased& erased) -> absl::Status {
        const absl::StatusOr<JobRow> row = store.Get<JobRow>(tenant, job);
        if (absl::IsDataLoss(row.status())) return store.Delete<JobRow>(tenant, job);
        BCCSKEL_RETURN_IF_ERROR(row.status());
        return EraseJob(store, *row, erased);
      },
      std::move(done));
}

absl::Status DurableJobs::EraseJob(JobStore& store, const JobRow& job, Erased& erased) {
  erased.traces = Erased::Traces::kErase;
  BCCSKEL_RETURN_IF_ERROR(CancelIfUnfinished(store, job, erased));
  BCCSKEL_RETURN_IF_ERROR(store.DeleteJob(job.number));
  if (job.result == 0) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const auto result, store.TakeResultIfUnused(job.result));
  if (!result.has_value() || result->file.empty()) return absl::OkStatus();
  erased.results.push_back(*result);
  return store.Put(RemovalRow{RemovalRow::Kind::kResult, result->tenant, result->file});
}

std::shared_ptr<Watch> DurableJobs::WatchJob(const std::string& tenant, const std::string& job,
                                             uint64_t after_sequence,
                                             std::shared_ptr<JobWatcher> watcher) {
  auto watch = std::make_shared<Watch>(after_sequence, std::move(watcher));
  BeginWatch(tenant, job, after_sequence, watch);
  return watch;
}

Flow DurableJobs::BeginWatch(std::string tenant, std::string job, uint64_t after_sequence,
                             std::shared_ptr<Watch> watch) {
  JobRow row;
  std::vector<EventRow> events;
  const absl::Status status = co_await Commit([&](JobStore& store) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(row, store.Get<JobRow>(tenant, job));
    // Send the final event even to a caller who knows it already.
    const bool ended = IsTerminal(row.state);
    const uint64_t after = ended ? std::min(after_sequence, row.sequence - 1) : after_sequence;
    BCCSKEL_ASSIGN_OR_RETURN(events, store.EventsAfter(row.number, after));
    return absl::OkStatus();
  });
  for (const EventRow& event : events) watch->Tell(EventOf(event));
  if (!status.ok() || IsTerminal(row.state)) co_return watch->End(status);
  watches_.Add(row.number, watch);
  TellStored(row.number);  // events of other servers that Sync() has already applied
}

Flow DurableJobs::OpenResult(std::string tenant, std::string job, uint64_t first_record,
                             Done<std::shared_ptr<ResultReader>> done) {
  const auto read = [&](JobStore& store) -> absl::StatusOr<ResultRow> {
    BCCSKEL_ASSIGN_OR_RETURN(const JobRow row, store.Get<JobRow>(tenant, job));
    BCCSKEL_ASSIGN_OR_RETURN(const auto result, store.FindResult(row.result));
    if (row.state != JobState::kSucceeded || !result.has_value()) {
      return CallError(Reason::kJobNotSucceeded, absl::StrCat(job, " has no result"));
    }
    if (!result->file.empty()) return *result;
    return absl::DataLossError(absl::StrCat(
        "the result of ", job, " was damaged: create the same job again to recompute it"));
  };
  const absl::StatusOr<ResultRow> found = co_await Read<ResultRow>(read);
  if (!found.ok()) co_return done(found.status());
  co_await ToFiles(tenant);
  auto reader = ResultReader::Open(*found, first_record, blobs_, files_);
  // The next equal job recomputes it, also for this one.
  if (absl::IsDataLoss(reader.status())) co_await Dropped(*found);
  done(std::move(reader));
}

}  // namespace bccskel::server
