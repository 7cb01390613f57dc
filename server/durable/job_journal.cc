#include "server/durable/job_journal.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

// More than the number of unstored events between two stored ones.
constexpr uint64_t kLeap = uint64_t{1} << 32;

absl::Status Poisoned(int crashes) {
  return CallError(
      Reason::kPoisoned,
      absl::StrCat("the server ended ", crashes,
                   " times while it ran this job, so it does not run it again; please report"),
      {.key = "attempts", .value = absl::StrCat(crashes)});
}

}  // namespace

uint64_t JobJournal::NextSequence(int64_t job, uint64_t stored) {
  uint64_t& last = sequences_[job];
  last = std::max(last, stored) + 1;
  return last;
}

absl::StatusOr<Step> JobJournal::AddEvent(JobStore& store, JobRow job, Time time) {
  EventRow event = {.job = job.number,
                    .sequence = job.sequence,
                    .time = time,
                    .state = job.state,
                    .attempt = job.attempts,
                    .error = job.error};
  BCCSKEL_RETURN_IF_ERROR(store.Insert(event));
  return Step{std::move(job), std::move(event)};
}

absl::StatusOr<Step> JobJournal::Insert(JobStore& store, JobRow job) {
  job.sequence = 1;
  job.created = now_();
  if (IsTerminal(job.state)) job.ended = job.created;
  BCCSKEL_ASSIGN_OR_RETURN(job.number, store.InsertJob(job));
  const Time time = job.created;
  return AddEvent(store, std::move(job), time);
}

absl::StatusOr<Step> JobJournal::Enter(JobStore& store, JobRow job, JobState state,
                                       absl::Status error, std::optional<uint64_t> from) {
  const Time time = now_();
  job.state = state;
  const bool untold = state == JobState::kCancelled && error.ok();
  job.error = untold ? JobCancelled() : std::move(error);
  job.sequence = NextSequence(job.number, job.sequence);
  job.owner = state == JobState::kRunning ? owner_ : std::string();
  if (state == JobState::kRunning) {
    ++job.attempts;
    job.started = time;
  }
  if (IsTerminal(state)) job.ended = time;
  BCCSKEL_ASSIGN_OR_RETURN(const bool changed, store.UpdateJob(job, from));
  if (!changed) return Step{std::move(job)};
  return AddEvent(store, std::move(job), time);
}

absl::StatusOr<std::optional<Step>> JobJournal::EnterRemembered(JobStore& store,
                                                                const JobRow& remembered,
                                                                JobState state,
                                                                const absl::Status& error,
                                                                int64_t result, const May& may) {
  JobRow job = remembered;
  job.result = result;
  if (may(job)) {
    BCCSKEL_ASSIGN_OR_RETURN(Step step, Enter(store, job, state, error, remembered.sequence));
    if (step.event.has_value()) return step;
  }
  BCCSKEL_ASSIGN_OR_RETURN(std::optional<JobRow> stored, store.Find<JobRow>(job.tenant, job.name));
  if (!stored.has_value() || !may(*stored)) return std::nullopt;
  stored->result = result;
  return Enter(store, *std::move(stored), state, error);
}

absl::StatusOr<Step> JobJournal::RecoverRunning(JobStore& store, JobRow job) {
  ++job.crashes;
  sequences_[job.number] = (job.sequence / kLeap + 1) * kLeap;
  const bool poisoned = job.crashes >= kCrashesToPoison;
  const absl::Status error = poisoned ? Poisoned(job.crashes) : absl::OkStatus();
  return Enter(store, std::move(job), poisoned ? JobState::kFailed : JobState::kQueued, error);
}

}  // namespace bccskel::server
