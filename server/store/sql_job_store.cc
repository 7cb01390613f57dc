#include "server/store/sql_job_store.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "core/exec/status_macros.h"
#include "server/store/row_columns.h"

namespace bccskel::server {
namespace {

absl::Status DamagedRow() {
  return absl::DataLossError("a row of the job store is not what was stored there");
}

SqlValue ToValue(const std::string& text) { return SqlValue::Text(text); }
SqlValue ToValue(int64_t number) { return SqlValue::Number(number); }
SqlValue ToValue(SqlValue value) { return value; }

class SqlJobStore final : public JobStore {
 public:
  explicit SqlJobStore(std::unique_ptr<SqlDatabase> database) : database_(std::move(database)) {}

  absl::StatusOr<std::string> Id() override {
    BCCSKEL_ASSIGN_OR_RETURN(auto rows, database_->Run("SELECT id FROM store", {}));
    return rows.empty() ? std::string() : rows.front().Text();
  }
  absl::Status Health() const override {
    return damaged_rows_ > 0 ? DamagedRow() : database_->Health();
  }
  int damaged_rows() const override { return damaged_rows_; }

  absl::Status Begin() override {
    const absl::Status begun = database_->Begin(server_);
    if (!absl::IsAborted(begun)) return begun;
    fenced_ = true;
    return absl::UnavailableError(begun.message());
  }
  absl::Status Commit() override { return Run("COMMIT"); }
  // A database may take a transaction back by itself.
  void Rollback() override {
    if (database_->InTransaction()) Run("ROLLBACK").IgnoreError();
  }
  absl::Status BeginStep() override { return Run("SAVEPOINT step"); }
  absl::Status KeepStep() override { return Run("RELEASE SAVEPOINT step"); }
  absl::Status UndoStep() override {
    BCCSKEL_RETURN_IF_ERROR(Run("ROLLBACK TO SAVEPOINT step"));
    return Run("RELEASE SAVEPOINT step");
  }

  absl::Status InsertUpload(const UploadRow& row) override {
    return Insert("INSERT INTO uploads(" BCCSKEL_UPLOAD_COLUMNS
                  ", row_check) VALUES($1, $2, $3, $4, $5, $6, $7, $8, $9)",
                  row);
  }
  absl::Status UpdateUpload(const UploadRow& row) override {
    return Run(
        "UPDATE uploads SET volume = $1, used = $2, file = $3, row_check = $4"
        " WHERE tenant = $5 AND name = $6",
        row.volume, Micros(row.used), row.file, CheckOf(row), row.tenant, row.name);
  }
  absl::Status DeleteUpload(const std::string& tenant, const std::string& name) override {
    return Run("DELETE FROM uploads WHERE tenant = $1 AND name = $2", tenant, name);
  }
  absl::StatusOr<std::optional<UploadRow>> FindUpload(const std::string& tenant,
                                                      const std::string& name) override {
    return One<UploadRow>(BCCSKEL_SELECT_UPLOAD "WHERE tenant = $1 AND name = $2", tenant, name);
  }
  absl::StatusOr<std::vector<UploadRow>> AllUploads() override {
    return Whole<UploadRow>(BCCSKEL_SELECT_UPLOAD);
  }

  absl::Status PutVolume(const VolumeRow& row) override {
    return Insert(
        "INSERT INTO volumes(" BCCSKEL_VOLUME_COLUMNS
        ", row_check) VALUES($1, $2, $3, $4, $5, $6, $7, $8, $9) ON CONFLICT(tenant, name)"
        " DO UPDATE SET declaration = excluded.declaration, blob_digest = excluded.blob_digest,"
        " volume_digest = excluded.volume_digest, size_bytes = excluded.size_bytes,"
        " created = excluded.created, used = excluded.used, row_check = excluded.row_check",
        row);
  }
  absl::Status DeleteVolume(const std::string& tenant, const std::string& name) override {
    BCCSKEL_RETURN_IF_ERROR(Run(
        "DELETE FROM uploads WHERE tenant = $1 AND volume = $2 AND volume != ''", tenant, name));
    return Run("DELETE FROM volumes WHERE tenant = $1 AND name = $2", tenant, name);
  }
  absl::StatusOr<std::optional<VolumeRow>> FindVolume(const std::string& tenant,
                                                      const std::string& name) override {
    return One<VolumeRow>(BCCSKEL_SELECT_VOLUME "WHERE tenant = $1 AND name = $2", tenant, name);
  }
  absl::StatusOr<std::vector<VolumeRow>> FindVolumesOf(const std::string& tenant,
                                                       const std::string& digest) override {
    return Whole<VolumeRow>(BCCSKEL_SELECT_VOLUME
                            "WHERE tenant = $1 AND"
                            " (blob_digest = $2 OR volume_digest = $2) ORDER BY name",
                            tenant, digest);
  }
  absl::StatusOr<std::vector<VolumeRow>> AllVolumes() override {
    return Whole<VolumeRow>(BCCSKEL_SELECT_VOLUME);
  }

  absl::StatusOr<int64_t> InsertJob(const JobRow& row) override {
    std::vector<SqlValue> values = ValuesOf(row);
    values.erase(values.begin());
    BCCSKEL_ASSIGN_OR_RETURN(
        auto rows,
        database_->Run("INSERT INTO jobs(" BCCSKEL_NEW_JOB_COLUMNS
                       ") VALUES($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15,"
                       " $16, $17, $18, $19, $20) RETURNING number",
                       values));
    JobRow stored = row;
    stored.number = rows.front().Number();
    BCCSKEL_RETURN_IF_ERROR(
        Run("UPDATE jobs SET row_check = $1 WHERE number = $2", CheckOf(stored), stored.number));
    return stored.number;
  }
  absl::StatusOr<bool> UpdateJob(const JobRow& row) override {
    BCCSKEL_ASSIGN_OR_RETURN(
        const auto changed,
        Query("UPDATE jobs SET volume = $1, state = $2, attempts = $3, crashes = $4,"
              " sequence = $5, owner = $6, error = $7, result = $8, started = $9, ended = $10,"
              " row_check = $11 WHERE number = $12 AND state < 3 RETURNING number",
              row.volume, Number(row.state), int64_t{row.attempts}, int64_t{row.crashes},
              Number(row.sequence), row.owner, SqlValue::Blob(BytesOf(row.error)), row.result,
              Micros(row.started), Micros(row.ended), CheckOf(row), row.number));
    return !changed.empty();
  }
  absl::Status DeleteJob(int64_t number) override {
    return Run("DELETE FROM jobs WHERE number = $1", number);
  }
  absl::Status DeleteDamagedJob(const std::string& tenant, const std::string& name) override {
    return Run("DELETE FROM jobs WHERE tenant = $1 AND name = $2", tenant, name);
  }
  absl::StatusOr<std::optional<JobRow>> FindJob(const std::string& tenant,
                                                const std::string& name) override {
    return One<JobRow>(BCCSKEL_SELECT_JOB "WHERE tenant = $1 AND name = $2", tenant, name);
  }
  absl::StatusOr<std::optional<JobRow>> FindJobOfRequest(const std::string& tenant,
                                                         const std::string& request_id) override {
    return One<JobRow>(BCCSKEL_SELECT_JOB
                       "WHERE tenant = $1 AND request_id = $2 AND request_id != ''",
                       tenant, request_id);
  }
  absl::StatusOr<std::vector<JobRow>> ListJobs(const std::string& tenant,
                                               const std::optional<JobPosition>& after,
                                               uint32_t states, int most) override {
    const int64_t created = after.has_value() ? Micros(after->created) : kNeverMicros;
    const std::string name = after.has_value() ? after->name : std::string();
    return All<JobRow>(Damaged::kFails,
                       BCCSKEL_SELECT_JOB
                       "WHERE tenant = $1 AND (created, name) < ($2, $3)"
                       " AND ((1 << state) & $4) != 0"
                       " ORDER BY created DESC, name DESC LIMIT $5",
                       tenant, created, name, int64_t{states}, int64_t{most});
  }
  absl::StatusOr<std::vector<JobRow>> UnfinishedJobs() override {
    return Whole<JobRow>(BCCSKEL_SELECT_JOB "WHERE state < 3 ORDER BY number");
  }
  absl::StatusOr<std::vector<JobRow>> JobsEndedBefore(Time time, int most) override {
    return Whole<JobRow>(BCCSKEL_SELECT_JOB
                         "WHERE state >= 3 AND ended < $1 ORDER BY ended LIMIT $2",
                         Micros(time), int64_t{most});
  }
  absl::StatusOr<std::optional<std::string>> UserOfVolume(const std::string& tenant,
                                                          const std::string& volume) override {
    BCCSKEL_ASSIGN_OR_RETURN(
        auto rows,
        Query("SELECT name FROM jobs WHERE state < 3 AND tenant = $1 AND volume = $2 LIMIT 1",
              tenant, volume));
    return rows.empty() ? std::nullopt : std::optional(rows.front().Text());
  }

  absl::Status InsertEvent(const EventRow& row) override {
    return Insert("INSERT INTO events(" BCCSKEL_EVENT_COLUMNS
                  ", row_check) VALUES($1, $2, $3, $4, $5, $6, $7)",
                  row);
  }
  absl::StatusOr<std::vector<EventRow>> EventsAfter(int64_t job, uint64_t sequence) override {
    return All<EventRow>(Damaged::kFails,
                         BCCSKEL_SELECT_EVENT "WHERE job = $1 AND sequence > $2 ORDER BY sequence",
                         job, Number(sequence));
  }

  absl::StatusOr<int64_t> InsertResult(const ResultRow& row) override {
    BCCSKEL_ASSIGN_OR_RETURN(const std::optional<ResultRow> found,
                             FindResultOf(row.tenant, row.key));
    if (found.has_value()) return found->number;
    std::vector<SqlValue> values = ValuesOf(row);
    values.erase(values.begin());
    BCCSKEL_ASSIGN_OR_RETURN(
        auto rows,
        database_->Run(
            "INSERT INTO results(tenant, key, file, file_digest, bytes, records, summary)"
            " VALUES($1, $2, $3, $4, $5, $6, $7) ON CONFLICT(tenant, key) DO UPDATE SET"
            " file = excluded.file, file_digest = excluded.file_digest,"
            " bytes = excluded.bytes, records = excluded.records,"
            " summary = excluded.summary RETURNING number",
            values));
    ResultRow stored = row;
    stored.number = rows.front().Number();
    BCCSKEL_RETURN_IF_ERROR(
        Run("UPDATE results SET row_check = $1 WHERE number = $2", CheckOf(stored), stored.number));
    return stored.number;
  }
  absl::Status DropResult(const ResultRow& row) override {
    ResultRow dropped = row;
    dropped.file.clear();
    return Run("UPDATE results SET file = '', row_check = $1 WHERE number = $2 AND file = $3",
               CheckOf(dropped), row.number, row.file);
  }
  absl::StatusOr<std::optional<ResultRow>> FindResult(int64_t number) override {
    return One<ResultRow>(BCCSKEL_SELECT_RESULT "WHERE number = $1", number);
  }
  absl::StatusOr<std::optional<ResultRow>> FindResultOf(const std::string& tenant,
                                                        const std::string& key) override {
    return FirstWhole<ResultRow>(
        BCCSKEL_SELECT_RESULT "WHERE tenant = $1 AND key = $2 AND file != ''", tenant, key);
  }
  absl::StatusOr<std::optional<ResultRow>> TakeResultIfUnused(int64_t number) override {
    return FirstWhole<ResultRow>(
        "DELETE FROM results WHERE number = $1 AND NOT EXISTS"
        " (SELECT 1 FROM jobs WHERE result = $1 AND result != 0)"
        " RETURNING " BCCSKEL_RESULT_COLUMNS ", row_check",
        number);
  }
  absl::StatusOr<std::vector<ResultRow>> AllResults() override {
    return Whole<ResultRow>(BCCSKEL_SELECT_RESULT);
  }

  absl::Status InsertRemoval(const RemovalRow& row) override {
    return Insert("INSERT INTO removals(" BCCSKEL_REMOVAL_COLUMNS
                  ", row_check) VALUES($1, $2, $3, $4) ON CONFLICT(kind, tenant, name)"
                  " DO UPDATE SET row_check = excluded.row_check",
                  row);
  }
  absl::Status DeleteRemoval(const RemovalRow& row) override {
    return Run("DELETE FROM removals WHERE kind = $1 AND tenant = $2 AND name = $3",
               static_cast<int64_t>(row.kind), row.tenant, row.name);
  }
  absl::StatusOr<std::vector<RemovalRow>> AllRemovals() override {
    return Whole<RemovalRow>(BCCSKEL_SELECT_REMOVAL);
  }

  bool shared() const override { return database_->shared(); }
  absl::Status Join(const std::string& server) override {
    if (!shared()) return absl::OkStatus();
    BCCSKEL_RETURN_IF_ERROR(Run("INSERT INTO servers(server, beats) VALUES($1, 0)", server));
    server_ = server;
    fenced_ = false;
    return absl::OkStatus();
  }
  absl::Status Leave() override {
    if (!shared()) return absl::OkStatus();
    return Run("DELETE FROM servers WHERE server = $1", server_);
  }
  bool fenced() const override { return fenced_; }
  absl::Status Beat() override {
    if (!shared()) return absl::OkStatus();
    return Run("UPDATE servers SET beats = beats + 1 WHERE server = $1", server_);
  }
  absl::StatusOr<std::vector<Member>> Members() override {
    std::vector<Member> members;
    if (!shared()) return members;
    BCCSKEL_ASSIGN_OR_RETURN(auto rows, database_->Run("SELECT server, beats FROM servers", {}));
    for (SqlRow& row : rows) members.push_back({.server = row.Text(), .beats = row.Number()});
    return members;
  }
  absl::StatusOr<bool> Fence(const Member& member) override {
    BCCSKEL_ASSIGN_OR_RETURN(
        const auto gone,
        Query("DELETE FROM servers WHERE server = $1 AND beats = $2 RETURNING beats", member.server,
              member.beats));
    return !gone.empty();
  }
  absl::StatusOr<JobChanges> ChangesAfter(int64_t number) override {
    JobChanges changes;
    changes.last = number;
    if (!shared()) return changes;
    // Taken first: what comes in between is told again.
    BCCSKEL_ASSIGN_OR_RETURN(
        auto last, database_->Run("SELECT CAST(greatest((SELECT max(changed) FROM jobs),"
                                  " (SELECT max(changed) FROM deleted_jobs), 0) AS BIGINT)",
                                  {}));
    changes.last = std::max(number, last.front().Number());
    if (changes.last == number) return changes;
    BCCSKEL_ASSIGN_OR_RETURN(
        changes.jobs,
        Whole<JobRow>(BCCSKEL_SELECT_JOB
                      "WHERE changed > $1 AND (state < 3 OR $1 >= 0) ORDER BY changed",
                      number));
    BCCSKEL_ASSIGN_OR_RETURN(auto gone,
                             Query("SELECT number FROM deleted_jobs WHERE changed > $1", number));
    for (SqlRow& row : gone) changes.deleted.push_back(row.Number());
    return changes;
  }
  absl::StatusOr<bool> RunsElsewhere(const JobRow& job, const std::string& volume_digest,
                                     const std::string& server) override {
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
  absl::StatusOr<std::map<std::string, uint64_t>> DiskUse() override {
    // Several volumes may have the same bytes.
    BCCSKEL_ASSIGN_OR_RETURN(
        auto rows,
        database_->Run(
            "SELECT tenant, CAST(sum(size) AS BIGINT) FROM"
            " (SELECT tenant, size_bytes AS size FROM uploads WHERE volume = ''"
            " UNION ALL SELECT tenant, max(size_bytes) AS size FROM volumes"
            " GROUP BY tenant, blob_digest"
            " UNION ALL SELECT tenant, bytes AS size FROM results WHERE file != '') AS files"
            " GROUP BY tenant",
            {}));
    std::map<std::string, uint64_t> used;
    for (SqlRow& row : rows) {
      std::string tenant = row.Text();
      used.emplace(std::move(tenant), static_cast<uint64_t>(row.Number()));
    }
    return used;
  }

  absl::Status Forget() override { return database_->Forget(); }

 private:
  enum class Damaged { kFails, kLeftOut };

  template <typename... Values>
  absl::StatusOr<std::vector<SqlRow>> Query(const char* sql, const Values&... values) {
    return database_->Run(sql, {ToValue(values)...});
  }
  template <typename... Values>
  absl::Status Run(const char* sql, const Values&... values) {
    return Query(sql, values...).status();
  }
  template <typename Row>
  absl::Status Insert(const char* sql, const Row& row) {
    std::vector<SqlValue> values = ValuesOf(row);
    values.push_back(SqlValue::Number(CheckOf(row)));
    return database_->Run(sql, values).status();
  }
  template <typename Row, typename... Values>
  absl::StatusOr<std::vector<Row>> All(Damaged damaged, const char* sql, const Values&... values) {
    BCCSKEL_ASSIGN_OR_RETURN(std::vector<SqlRow> found, Query(sql, values...));
    std::vector<Row> rows;
    for (SqlRow& from : found) {
      Row& row = rows.emplace_back();
      const int64_t check = CheckOf(from, row);
      Read(from, row);
      if (from.Number() == check) continue;
      ++damaged_rows_;
      if (damaged == Damaged::kFails) return DamagedRow();
      rows.pop_back();
    }
    return rows;
  }
  // For who looks after everything, and must not stop at a row that is damaged.
  template <typename Row, typename... Values>
  absl::StatusOr<std::vector<Row>> Whole(const char* sql, const Values&... values) {
    return All<Row>(Damaged::kLeftOut, sql, values...);
  }
  template <typename Row, typename... Values>
  absl::StatusOr<std::optional<Row>> One(const char* sql, const Values&... values) {
    return FirstOf(All<Row>(Damaged::kFails, sql, values...));
  }
  template <typename Row, typename... Values>
  absl::StatusOr<std::optional<Row>> FirstWhole(const char* sql, const Values&... values) {
    return FirstOf(Whole<Row>(sql, values...));
  }
  template <typename Row>
  static absl::StatusOr<std::optional<Row>> FirstOf(absl::StatusOr<std::vector<Row>> rows) {
    BCCSKEL_RETURN_IF_ERROR(rows.status());
    if (rows->empty()) return std::nullopt;
    return std::optional<Row>(std::move(rows->front()));
  }

  const std::unique_ptr<SqlDatabase> database_;
  std::string server_;  // empty before it has joined
  bool fenced_ = false;
  std::atomic<int> damaged_rows_ = 0;
};

}  // namespace

std::unique_ptr<JobStore> MakeSqlJobStore(std::unique_ptr<SqlDatabase> database) {
  return std::make_unique<SqlJobStore>(std::move(database));
}

}  // namespace bccskel::server
