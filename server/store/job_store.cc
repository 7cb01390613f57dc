#include "server/store/job_store.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "server/store/tables.h"

namespace bccskel::server {
namespace {

constexpr char kByName[] = "WHERE tenant = $1 AND name = $2";

absl::Status DamagedRow() {
  return absl::DataLossError("a row of the job store is not what was stored there");
}

}  // namespace

absl::StatusOr<std::vector<SqlRow>> JobStore::Execute(const std::string& sql,
                                                      const std::vector<SqlValue>& values) {
  auto rows = database_->Run(sql, values);
  if (!rows.ok() || !absl::StartsWith(sql, "SELECT")) ++traces_;
  return rows;
}

template <typename... Values>
absl::StatusOr<std::vector<SqlRow>> JobStore::Query(const std::string& sql,
                                                    const Values&... values) {
  return Execute(sql, {ToValue(values)...});
}

template <typename... Values>
absl::Status JobStore::Run(const std::string& sql, const Values&... values) {
  return Query(sql, values...).status();
}

template <typename Row>
absl::Status JobStore::Put(const Row& row) {
  return Put(row, std::is_same_v<Row, RemovalRow> ? "kind, tenant, name" : "tenant, name");
}

template <typename Row>
absl::Status JobStore::Put(const Row& row, const std::string& key) {
  std::vector<SqlValue> values = ValuesOf(row);
  values.push_back(SqlValue::Number(CheckOf(row)));
  return Execute(
             absl::StrCat("INSERT INTO ", TableOf(row), "(", absl::StrJoin(ColumnsOf(row), ", "),
                          ") VALUES(", Parameters(values.size()), ")",
                          key.empty() ? "" : Replacing(key, ColumnsOf(row))),
             values)
      .status();
}

template <typename Row>
absl::Status JobStore::Delete(const std::string& tenant, const std::string& name) {
  return Run(absl::StrCat("DELETE FROM ", TableOf(Row()), " ", kByName), tenant, name);
}

template <typename Row, typename... Values>
absl::StatusOr<std::vector<Row>> JobStore::Select(Damaged damaged, const std::string& where,
                                                  const Values&... values) {
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<SqlRow> found,
                           Query(absl::StrCat("SELECT ", absl::StrJoin(ColumnsOf(Row()), ", "),
                                              " FROM ", TableOf(Row()), " ", where),
                                 values...));
  std::vector<Row> rows;
  for (SqlRow& from : found) {
    Row& row = rows.emplace_back();
    const int64_t check = CheckOf(from, row);
    ForEachColumn(row, [&](const char*, auto& field, Kind = Kind::kNumber) { Read(from, field); });
    if (from.Number() == check) continue;
    ++damaged_rows_;
    if (damaged == Damaged::kFails) return DamagedRow();
    rows.pop_back();
  }
  return rows;
}

template <typename Row>
absl::StatusOr<std::vector<Row>> JobStore::All() {
  return Select<Row>(Damaged::kLeftOut, "");
}

template <typename Row, typename... Values>
absl::StatusOr<std::optional<Row>> JobStore::One(Damaged damaged, const std::string& where,
                                                 const Values&... values) {
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<Row> rows, Select<Row>(damaged, where, values...));
  if (rows.empty()) return std::nullopt;
  return std::optional<Row>(std::move(rows.front()));
}

template <typename Row>
absl::StatusOr<std::optional<Row>> JobStore::Find(const std::string& tenant,
                                                  const std::string& name) {
  return One<Row>(Damaged::kFails, kByName, tenant, name);
}

template <typename Row>
absl::StatusOr<Row> JobStore::Get(const std::string& tenant, const std::string& name) {
  BCCSKEL_ASSIGN_OR_RETURN(std::optional<Row> row, Find<Row>(tenant, name));
  if (row.has_value()) return *std::move(row);
  std::string kind = TableOf(Row());
  kind.pop_back();  // the plural's "s"
  return absl::NotFoundError(absl::StrCat("there is no ", kind, " ", name));
}

template absl::Status JobStore::Put(const UploadRow&, const std::string&);
template absl::Status JobStore::Put(const EventRow&, const std::string&);
template absl::Status JobStore::Put(const UploadRow&);
template absl::Status JobStore::Put(const VolumeRow&);
template absl::Status JobStore::Put(const RemovalRow&);
template absl::StatusOr<std::optional<UploadRow>> JobStore::Find(const std::string&,
                                                                 const std::string&);
template absl::StatusOr<std::optional<VolumeRow>> JobStore::Find(const std::string&,
                                                                 const std::string&);
template absl::StatusOr<std::optional<JobRow>> JobStore::Find(const std::string&,
                                                              const std::string&);
template absl::StatusOr<UploadRow> JobStore::Get(const std::string&, const std::string&);
template absl::StatusOr<VolumeRow> JobStore::Get(const std::string&, const std::string&);
template absl::StatusOr<JobRow> JobStore::Get(const std::string&, const std::string&);
template absl::Status JobStore::Delete<UploadRow>(const std::string&, const std::string&);
template absl::Status JobStore::Delete<JobRow>(const std::string&, const std::string&);
template absl::StatusOr<std::vector<UploadRow>> JobStore::All();
template absl::StatusOr<std::vector<VolumeRow>> JobStore::All();
template absl::StatusOr<std::vector<ResultRow>> JobStore::All();
template absl::StatusOr<std::vector<RemovalRow>> JobStore::All();

absl::StatusOr<std::string> JobStore::Id() {
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, Query("SELECT id FROM store"));
  return rows.empty() ? std::string() : rows.front().Text();
}

absl::Status JobStore::Health() const {
  return damaged_rows_ > 0 ? DamagedRow() : database_->Health();
}

absl::Status JobStore::Begin() {
  absl::Status begun = database_->Begin(server_);
  if (!absl::IsAborted(begun)) return begun;
  fenced_ = true;
  return absl::UnavailableError(begun.message());
}

absl::Status JobStore::Commit() { return Run("COMMIT"); }

// The database may have rolled back the transaction by itself.
void JobStore::Rollback() {
  if (database_->InTransaction()) Run("ROLLBACK").IgnoreError();
}

absl::Status JobStore::BeginStep() { return Run("SAVEPOINT step"); }
absl::Status JobStore::KeepStep() { return Run("RELEASE SAVEPOINT step"); }
absl::Status JobStore::UndoStep() {
  BCCSKEL_RETURN_IF_ERROR(Run("ROLLBACK TO SAVEPOINT step"));
  return KeepStep();
}

absl::Status JobStore::DeleteVolume(const std::string& tenant, const std::string& name) {
  BCCSKEL_RETURN_IF_ERROR(
      Run("DELETE FROM uploads WHERE tenant = $1 AND volume = $2 AND volume != ''", tenant, name));
  return Delete<VolumeRow>(tenant, name);
}

absl::StatusOr<std::vector<VolumeRow>> JobStore::FindVolumesOf(const std::string& tenant,
                                                               const std::string& digest) {
  return Select<VolumeRow>(
      Damaged::kLeftOut,
      "WHERE tenant = $1 AND (blob_digest = $2 OR volume_digest = $2) ORDER BY name", tenant,
      digest);
}

// The number comes first because the checksum includes it.
absl::StatusOr<int64_t> JobStore::InsertJob(JobRow row) {
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, Query("SELECT " + database_->NextNumber("jobs")));
  row.number = rows.front().Number();
  BCCSKEL_RETURN_IF_ERROR(Insert(row));
  return row.number;
}

absl::StatusOr<bool> JobStore::UpdateJob(const JobRow& row, std::optional<uint64_t> from) {
  BCCSKEL_ASSIGN_OR_RETURN(
      const auto changed,
      Query("UPDATE jobs SET volume = $1, state = $2, attempts = $3, crashes = $4,"
            " sequence = $5, owner = $6, error = $7, result = $8, started = $9, ended = $10,"
            " row_check = $11 WHERE number = $12 AND state < 3 AND $13 IN (sequence, -1)"
            " RETURNING number",
            row.volume, row.state, row.attempts, row.crashes, row.sequence, row.owner, row.error,
            row.result, row.started, row.ended, CheckOf(row), row.number,
            static_cast<int64_t>(from.value_or(-1))));
  return !changed.empty();
}

absl::Status JobStore::DeleteJob(int64_t number) {
  return Run("DELETE FROM jobs WHERE number = $1", number);
}

absl::StatusOr<std::optional<JobRow>> JobStore::FindJobOfRequest(const std::string& tenant,
                                                                 const std::string& request_id) {
  return One<JobRow>(Damaged::kFails, "WHERE tenant = $1 AND request_id = $2 AND request_id != ''",
                     tenant, request_id);
}

absl::StatusOr<std::vector<JobRow>> JobStore::ListJobs(const std::string& tenant,
                                                       const std::optional<JobPosition>& after,
                                                       uint32_t states, int most) {
  const int64_t created =
      after.has_value() ? Micros(after->created) : std::numeric_limits<int64_t>::max();
  const std::string name = after.has_value() ? after->name : std::string();
  return Select<JobRow>(
      Damaged::kFails,
      "WHERE tenant = $1 AND (created, name) < ($2, $3)"
      " AND ((1 << CAST(state AS INTEGER)) & $4) != 0 ORDER BY created DESC, name DESC LIMIT $5",
      tenant, created, name, states, most);
}

absl::StatusOr<std::vector<JobRow>> JobStore::UnfinishedJobs() {
  return Select<JobRow>(Damaged::kLeftOut, "WHERE state < 3 ORDER BY number");
}

absl::StatusOr<std::vector<JobRow>> JobStore::JobsEndedBefore(Time time, int most) {
  return Select<JobRow>(Damaged::kLeftOut,
                        "WHERE state >= 3 AND ended < $1 ORDER BY ended LIMIT $2", time, most);
}

absl::StatusOr<std::optional<std::string>> JobStore::UserOfVolume(const std::string& tenant,
                                                                  const std::string& volume) {
  BCCSKEL_ASSIGN_OR_RETURN(
      auto rows,
      Query("SELECT name FROM jobs WHERE state < 3 AND tenant = $1 AND volume = $2 LIMIT 1", tenant,
            volume));
  return rows.empty() ? std::nullopt : std::optional(rows.front().Text());
}

absl::StatusOr<std::vector<EventRow>> JobStore::EventsAfter(int64_t job, uint64_t sequence) {
  return Select<EventRow>(Damaged::kFails, "WHERE job = $1 AND sequence > $2 ORDER BY sequence",
                          job, sequence);
}

absl::StatusOr<ResultRow> JobStore::InsertResult(ResultRow row) {
  BCCSKEL_ASSIGN_OR_RETURN(std::optional<ResultRow> found, FindResultOf(row.tenant, row.key));
  if (found.has_value()) return *std::move(found);
  const std::string next =
      "SELECT coalesce((SELECT number FROM results WHERE tenant = $1 AND "
      "key = $2), " +
      database_->NextNumber("results") + ")";
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, Query(next, row.tenant, row.key));
  row.number = rows.front().Number();
  BCCSKEL_RETURN_IF_ERROR(Put(row, "tenant, key"));
  return row;
}

absl::Status JobStore::DropResult(const ResultRow& row) {
  ResultRow dropped = row;
  dropped.file.clear();
  return Run("UPDATE results SET file = '', row_check = $1 WHERE number = $2 AND file = $3",
             CheckOf(dropped), row.number, row.file);
}

absl::StatusOr<std::optional<ResultRow>> JobStore::FindResult(int64_t number) {
  return One<ResultRow>(Damaged::kFails, "WHERE number = $1", number);
}

absl::StatusOr<std::optional<ResultRow>> JobStore::FindResultOf(const std::string& tenant,
                                                                const std::string& key) {
  return One<ResultRow>(Damaged::kLeftOut, "WHERE tenant = $1 AND key = $2 AND file != ''", tenant,
                        key);
}

absl::StatusOr<std::optional<ResultRow>> JobStore::TakeResultIfUnused(int64_t number) {
  static const std::string unused =
      "WHERE number = $1 AND NOT EXISTS (SELECT 1 FROM jobs WHERE result = $1 AND result != 0)";
  BCCSKEL_ASSIGN_OR_RETURN(auto taken, One<ResultRow>(Damaged::kLeftOut, unused, number));
  BCCSKEL_RETURN_IF_ERROR(Run("DELETE FROM results " + unused, number));
  return taken;
}

absl::Status JobStore::DeleteRemoval(const RemovalRow& row) {
  return Run("DELETE FROM removals WHERE kind = $1 AND tenant = $2 AND name = $3", row.kind,
             row.tenant, row.name);
}

absl::Status JobStore::Join(const std::string& server) {
  BCCSKEL_RETURN_IF_ERROR(Run("INSERT INTO servers(server, beats) VALUES($1, 0)", server));
  server_ = server;
  fenced_ = false;
  return absl::OkStatus();
}

absl::Status JobStore::Leave() { return Run("DELETE FROM servers WHERE server = $1", server_); }

absl::Status JobStore::Beat() {
  return Run("UPDATE servers SET beats = beats + 1 WHERE server = $1", server_);
}

absl::StatusOr<std::vector<Member>> JobStore::Members() {
  std::vector<Member> members;
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, Query("SELECT server, beats FROM servers"));
  for (SqlRow& row : rows) members.push_back({.server = row.Text(), .beats = row.Number()});
  return members;
}

absl::StatusOr<bool> JobStore::Fence(const Member& member) {
  BCCSKEL_ASSIGN_OR_RETURN(
      const auto gone, Query("DELETE FROM servers WHERE server = $1 AND beats = $2 RETURNING beats",
                             member.server, member.beats));
  return !gone.empty();
}

absl::StatusOr<JobChanges> JobStore::ChangesAfter(int64_t number) {
  JobChanges changes;
  changes.last = number;
  // Read first: later changes are reported again.
  BCCSKEL_ASSIGN_OR_RETURN(auto last,
                           Query("SELECT CAST(greatest((SELECT max(changed) FROM jobs),"
                                 " (SELECT max(changed) FROM deleted_jobs), 0) AS BIGINT)"));
  changes.last = std::max(number, last.front().Number());
  if (changes.last == number) return changes;
  BCCSKEL_ASSIGN_OR_RETURN(
      changes.jobs,
      Select<JobRow>(Damaged::kLeftOut,
                     "WHERE changed > $1 AND (state < 3 OR $1 >= 0) ORDER BY changed", number));
  BCCSKEL_ASSIGN_OR_RETURN(auto gone,
                           Query("SELECT number FROM deleted_jobs WHERE changed > $1", number));
  for (SqlRow& row : gone) changes.deleted.push_back(row.Number());
  return changes;
}

absl::StatusOr<bool> JobStore::RunsElsewhere(const JobRow& job, const std::string& volume_digest,
                                             const std::string& server) {
  BCCSKEL_ASSIGN_OR_RETURN(
      const auto rows,
      Query("SELECT 1 FROM jobs LEFT JOIN volumes"
            " ON volumes.tenant = jobs.tenant AND volumes.name = jobs.volume"
            " WHERE jobs.state = 2 AND jobs.tenant = $1 AND jobs.options = $2"
            " AND jobs.owner != $3 AND (jobs.volume = $4"
            " OR (volumes.volume_digest = $5 AND volumes.volume_digest != '')) LIMIT 1",
            job.tenant, SqlValue::Blob(job.options), server, job.volume, volume_digest));
  return !rows.empty();
}

absl::Status JobStore::PutProgress(int64_t job, const ProgressRow& progress) {
  return Run("INSERT INTO progress(job, sequence, bytes) VALUES($1, $2, $3)" +
                 Replacing("job", {"sequence", "bytes"}),
             job, progress.sequence, progress.bytes);
}

absl::StatusOr<std::optional<ProgressRow>> JobStore::FindProgress(int64_t job) {
  BCCSKEL_ASSIGN_OR_RETURN(auto rows,
                           Query("SELECT sequence, bytes FROM progress WHERE job = $1", job));
  if (rows.empty()) return std::nullopt;
  return ProgressRow{static_cast<uint64_t>(rows.front().Number()), rows.front().Text()};
}

absl::StatusOr<std::map<std::string, uint64_t>> JobStore::DiskUse() {
  // Several volumes may have the same bytes.
  BCCSKEL_ASSIGN_OR_RETURN(
      auto rows, Query("SELECT tenant, CAST(sum(size) AS BIGINT) FROM"
                       " (SELECT tenant, size_bytes AS size FROM uploads WHERE volume = ''"
                       " UNION ALL SELECT tenant, max(size_bytes) AS size FROM volumes"
                       " GROUP BY tenant, blob_digest"
                       " UNION ALL SELECT tenant, bytes AS size FROM results WHERE file != '')"
                       " AS files GROUP BY tenant"));
  std::map<std::string, uint64_t> used;
  for (SqlRow& row : rows) {
    std::string tenant = row.Text();
    used.emplace(std::move(tenant), static_cast<uint64_t>(row.Number()));
  }
  return used;
}

absl::Status JobStore::Forget() { return database_->Forget(); }

}  // namespace bccskel::server
