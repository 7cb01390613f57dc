#include "server/store/sqlite_job_store.h"

#include <atomic>
#include <utility>

#include "core/exec/status_macros.h"
#include "server/store/row_columns.h"
#include "server/store/schema.h"
#include "server/store/sqlite_database.h"
#include "server/store/stored_status.h"

namespace bccskel::server {
namespace {

absl::Status DamagedRow() {
  return absl::DataLossError("a row of the job store is not what was stored there");
}

class SqliteJobStore final : public JobStore {
 public:
  explicit SqliteJobStore(std::unique_ptr<SqliteDatabase> database)
      : database_(std::move(database)) {}

  absl::StatusOr<std::string> Id() override {
    SqliteQuery query(*database_, "SELECT id FROM store");
    BCCSKEL_ASSIGN_OR_RETURN(const bool found, query.Next());
    return found ? query.Text() : std::string();
  }
  absl::Status Health() const override {
    return damaged_rows_ > 0 ? DamagedRow() : database_->CheckFile();
  }
  int damaged_rows() const override { return damaged_rows_; }

  absl::Status Begin() override {
    BCCSKEL_RETURN_IF_ERROR(database_->CheckFile());
    return Run("BEGIN IMMEDIATE");
  }
  absl::Status Commit() override { return Run("COMMIT"); }
  // SQLite itself takes a transaction back after some errors.
  void Rollback() override {
    if (database_->InTransaction()) Run("ROLLBACK").IgnoreError();
  }
  absl::Status BeginStep() override { return Run("SAVEPOINT step"); }
  absl::Status KeepStep() override { return Run("RELEASE step"); }
  absl::Status UndoStep() override {
    BCCSKEL_RETURN_IF_ERROR(Run("ROLLBACK TO step"));
    return Run("RELEASE step");
  }

  absl::Status InsertUpload(const UploadRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(Run("INSERT INTO uploads(" BCCSKEL_UPLOAD_COLUMNS
                                ") VALUES(?, ?, ?, ?, ?, ?, ?)",
                                row.tenant, row.name, Blob{row.declaration}, Number(row.size_bytes),
                                row.job, row.volume, Micros(row.used)));
    return SealUpload(row);
  }
  absl::Status UpdateUpload(const UploadRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(
        Run("UPDATE uploads SET volume = ?, used = ? WHERE tenant = ? AND name = ?", row.volume,
            Micros(row.used), row.tenant, row.name));
    return SealUpload(row);
  }
  absl::Status DeleteUpload(const std::string& tenant, const std::string& name) override {
    return Run("DELETE FROM uploads WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::optional<UploadRow>> FindUpload(const std::string& tenant,
                                                      const std::string& name) override {
    return One<UploadRow>(BCCSKEL_SELECT_UPLOAD "WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::vector<UploadRow>> AllUploads() override {
    return Whole<UploadRow>(BCCSKEL_SELECT_UPLOAD);
  }

  absl::Status PutVolume(const VolumeRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(Run(
        "INSERT OR REPLACE INTO volumes(" BCCSKEL_VOLUME_COLUMNS ") VALUES(?, ?, ?, ?, ?, ?, ?, ?)",
        row.tenant, row.name, Blob{row.declaration}, row.blob_digest, row.volume_digest,
        Number(row.size_bytes), Micros(row.created), Micros(row.used)));
    return Run(BCCSKEL_SEAL("volumes", BCCSKEL_VOLUME_COLUMNS) "tenant = ? AND name = ?",
               row.tenant, row.name);
  }
  absl::Status DeleteVolume(const std::string& tenant, const std::string& name) override {
    BCCSKEL_RETURN_IF_ERROR(
        Run("DELETE FROM uploads WHERE tenant = ? AND volume = ? AND volume != ''", tenant, name));
    return Run("DELETE FROM volumes WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::optional<VolumeRow>> FindVolume(const std::string& tenant,
                                                      const std::string& name) override {
    return One<VolumeRow>(BCCSKEL_SELECT_VOLUME "WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::vector<VolumeRow>> FindVolumesOf(const std::string& tenant,
                                                       const std::string& digest) override {
    return Whole<VolumeRow>(BCCSKEL_SELECT_VOLUME
                            "WHERE tenant = ?1 AND"
                            " (blob_digest = ?2 OR volume_digest = ?2) ORDER BY name",
                            tenant, digest);
  }
  absl::StatusOr<std::vector<VolumeRow>> AllVolumes() override {
    return Whole<VolumeRow>(BCCSKEL_SELECT_VOLUME);
  }

  absl::StatusOr<int64_t> InsertJob(const JobRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(Run(
        "INSERT INTO jobs(tenant, name, request_id, body, upload, options, priority, threads,"
        " trace, created, volume, state, attempts, crashes, sequence, owner, error, result,"
        " started, ended) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        row.tenant, row.name, row.request_id, Blob{row.body}, row.upload, Blob{row.options},
        int64_t{row.priority}, int64_t{row.threads}, row.trace, Micros(row.created), row.volume,
        Number(row.state), int64_t{row.attempts}, int64_t{row.crashes}, Number(row.sequence),
        row.owner, Blob{BytesOf(row.error)}, row.result, Micros(row.started), Micros(row.ended)));
    const int64_t number = database_->LastRow();
    BCCSKEL_RETURN_IF_ERROR(SealJob(number));
    return number;
  }
  absl::StatusOr<bool> UpdateJob(const JobRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(
        Run("UPDATE jobs SET volume = ?, state = ?, attempts = ?, crashes = ?, sequence = ?,"
            " owner = ?, error = ?, result = ?, started = ?, ended = ?"
            " WHERE number = ? AND state < 3",
            row.volume, Number(row.state), int64_t{row.attempts}, int64_t{row.crashes},
            Number(row.sequence), row.owner, Blob{BytesOf(row.error)}, row.result,
            Micros(row.started), Micros(row.ended), row.number));
    if (database_->Changes() != 1) return false;
    BCCSKEL_RETURN_IF_ERROR(SealJob(row.number));
    return true;
  }
  absl::Status DeleteJob(int64_t number) override {
    return Run("DELETE FROM jobs WHERE number = ?", number);
  }
  absl::Status DeleteDamagedJob(const std::string& tenant, const std::string& name) override {
    return Run("DELETE FROM jobs WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::optional<JobRow>> FindJob(const std::string& tenant,
                                                const std::string& name) override {
    return One<JobRow>(BCCSKEL_SELECT_JOB "WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::optional<JobRow>> FindJobOfRequest(const std::string& tenant,
                                                         const std::string& request_id) override {
    return One<JobRow>(BCCSKEL_SELECT_JOB
                       "WHERE tenant = ? AND request_id = ? AND request_id != ''",
                       tenant, request_id);
  }
  absl::StatusOr<std::vector<JobRow>> ListJobs(const std::string& tenant,
                                               const std::optional<JobPosition>& after,
                                               uint32_t states, int most) override {
    const int64_t created = after.has_value() ? Micros(after->created) : kNeverMicros;
    const std::string name = after.has_value() ? after->name : std::string();
    return All<JobRow>(Damaged::kFails,
                       BCCSKEL_SELECT_JOB
                       "WHERE tenant = ? AND (created, name) < (?, ?)"
                       " AND (1 << state) & ? != 0 ORDER BY created DESC, name DESC LIMIT ?",
                       tenant, created, name, int64_t{states}, int64_t{most});
  }
  absl::StatusOr<std::vector<JobRow>> UnfinishedJobs() override {
    return Whole<JobRow>(BCCSKEL_SELECT_JOB "WHERE state < 3 ORDER BY number");
  }
  absl::StatusOr<std::vector<JobRow>> JobsEndedBefore(Time time, int most) override {
    return Whole<JobRow>(BCCSKEL_SELECT_JOB "WHERE state >= 3 AND ended < ? ORDER BY ended LIMIT ?",
                         Micros(time), int64_t{most});
  }
  absl::StatusOr<std::optional<std::string>> UserOfVolume(const std::string& tenant,
                                                          const std::string& volume) override {
    SqliteQuery query(*database_,
                      "SELECT name FROM jobs WHERE state < 3 AND tenant = ? AND volume = ? LIMIT 1",
                      tenant, volume);
    BCCSKEL_ASSIGN_OR_RETURN(const bool found, query.Next());
    return found ? std::optional(query.Text()) : std::nullopt;
  }

  absl::Status InsertEvent(const EventRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(Run("INSERT INTO events(" BCCSKEL_EVENT_COLUMNS
                                ") VALUES(?, ?, ?, ?, ?, ?)",
                                row.job, Number(row.sequence), Micros(row.time), Number(row.state),
                                int64_t{row.attempt}, Blob{BytesOf(row.error)}));
    return Run(BCCSKEL_SEAL("events", BCCSKEL_EVENT_COLUMNS) "job = ? AND sequence = ?", row.job,
               Number(row.sequence));
  }
  absl::StatusOr<std::vector<EventRow>> EventsAfter(int64_t job, uint64_t sequence) override {
    return All<EventRow>(Damaged::kFails,
                         BCCSKEL_SELECT_EVENT "WHERE job = ? AND sequence > ? ORDER BY sequence",
                         job, Number(sequence));
  }

  absl::StatusOr<int64_t> InsertResult(const ResultRow& row) override {
    BCCSKEL_ASSIGN_OR_RETURN(const std::optional<ResultRow> found,
                             FindResultOf(row.tenant, row.key));
    if (found.has_value()) return found->number;
    BCCSKEL_RETURN_IF_ERROR(
        Run("INSERT INTO results(tenant, key, file, file_digest, bytes, records, summary)"
            " VALUES(?, ?, ?, ?, ?, ?, ?) ON CONFLICT(tenant, key) DO UPDATE SET"
            " file = excluded.file, file_digest = excluded.file_digest, bytes = excluded.bytes,"
            " records = excluded.records, summary = excluded.summary",
            row.tenant, row.key, row.file, row.file_digest, Number(row.bytes), Number(row.records),
            Blob{row.summary}));
    BCCSKEL_RETURN_IF_ERROR(
        Run(BCCSKEL_SEAL("results", BCCSKEL_RESULT_COLUMNS) "tenant = ? AND key = ?", row.tenant,
            row.key));
    BCCSKEL_ASSIGN_OR_RETURN(const auto stored, FindResultOf(row.tenant, row.key));
    return stored.has_value() ? absl::StatusOr<int64_t>(stored->number) : DamagedRow();
  }
  absl::Status DropResult(const ResultRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(
        Run("UPDATE results SET file = '' WHERE number = ? AND file = ?", row.number, row.file));
    return Run(BCCSKEL_SEAL("results", BCCSKEL_RESULT_COLUMNS) "number = ? AND file = ''",
               row.number);
  }
  absl::StatusOr<std::optional<ResultRow>> FindResult(int64_t number) override {
    return One<ResultRow>(BCCSKEL_SELECT_RESULT "WHERE number = ?", number);
  }
  absl::StatusOr<std::optional<ResultRow>> FindResultOf(const std::string& tenant,
                                                        const std::string& key) override {
    return FirstWhole<ResultRow>(
        BCCSKEL_SELECT_RESULT "WHERE tenant = ? AND key = ? AND file != ''", tenant, key);
  }
  absl::StatusOr<std::optional<ResultRow>> TakeResultIfUnused(int64_t number) override {
    return FirstWhole<ResultRow>(
        "DELETE FROM results WHERE number = ?1 AND NOT EXISTS"
        " (SELECT 1 FROM jobs WHERE result = ?1 AND result != 0)"
        " RETURNING " BCCSKEL_READ("results", BCCSKEL_RESULT_COLUMNS),
        number);
  }
  absl::StatusOr<std::vector<ResultRow>> AllResults() override {
    return Whole<ResultRow>(BCCSKEL_SELECT_RESULT);
  }

  absl::Status InsertRemoval(const RemovalRow& row) override {
    const auto kind = static_cast<int64_t>(row.kind);
    BCCSKEL_RETURN_IF_ERROR(Run("INSERT OR REPLACE INTO removals(" BCCSKEL_REMOVAL_COLUMNS
                                ") VALUES(?, ?, ?)",
                                kind, row.tenant, row.name));
    return Run(
        BCCSKEL_SEAL("removals", BCCSKEL_REMOVAL_COLUMNS) "kind = ? AND tenant = ? AND name = ?",
        kind, row.tenant, row.name);
  }
  absl::Status DeleteRemoval(const RemovalRow& row) override {
    return Run("DELETE FROM removals WHERE kind = ? AND tenant = ? AND name = ?",
               static_cast<int64_t>(row.kind), row.tenant, row.name);
  }
  absl::StatusOr<std::vector<RemovalRow>> AllRemovals() override {
    return Whole<RemovalRow>(BCCSKEL_SELECT_REMOVAL);
  }

  absl::Status Forget() override { return database_->Execute("PRAGMA wal_checkpoint(TRUNCATE)"); }

 private:
  enum class Damaged { kFails, kLeftOut };

  absl::Status SealUpload(const UploadRow& row) {
    return Run(BCCSKEL_SEAL("uploads", BCCSKEL_UPLOAD_COLUMNS) "tenant = ? AND name = ?",
               row.tenant, row.name);
  }
  absl::Status SealJob(int64_t number) {
    return Run(BCCSKEL_SEAL("jobs", BCCSKEL_JOB_COLUMNS) "number = ?", number);
  }

  template <typename... Values>
  absl::Status Run(const char* sql, const Values&... values) {
    return SqliteQuery(*database_, sql, values...).Run();
  }
  template <typename Row, typename... Values>
  absl::StatusOr<std::vector<Row>> All(Damaged damaged, const char* sql, const Values&... values) {
    SqliteQuery query(*database_, sql, values...);
    std::vector<Row> rows;
    while (true) {
      BCCSKEL_ASSIGN_OR_RETURN(const bool found, query.Next());
      if (!found) return rows;
      Read(query, rows.emplace_back());
      if (query.Number() == 1) continue;
      ++damaged_rows_;
      if (damaged == Damaged::kFails) return DamagedRow();
      rows.pop_back();
    }
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

  const std::unique_ptr<SqliteDatabase> database_;
  std::atomic<int> damaged_rows_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<SqliteDatabase> database, SqliteDatabase::Open(path));
  BCCSKEL_RETURN_IF_ERROR(Migrate(*database));
  std::unique_ptr<JobStore> store = std::make_unique<SqliteJobStore>(std::move(database));
  // So that the tables have their room before the disk is full; where it is already, without.
  store->Forget().IgnoreError();
  return store;
}

}  // namespace bccskel::server
