#include "server/store/sqlite_job_store.h"

#include <chrono>
#include <limits>
#include <utility>

#include "core/exec/status_macros.h"
#include "server/store/schema.h"
#include "server/store/sqlite_database.h"
#include "server/store/stored_status.h"

namespace bccskel::server {
namespace {

using std::chrono::duration_cast, std::chrono::microseconds;

constexpr int64_t kNeverMicros = std::numeric_limits<int64_t>::max();

int64_t Number(uint64_t value) { return static_cast<int64_t>(value); }
int64_t Number(JobState state) { return static_cast<int64_t>(state); }
int64_t Micros(Time time) { return duration_cast<microseconds>(time.time_since_epoch()).count(); }
int64_t Micros(const std::optional<Time>& time) { return time.has_value() ? Micros(*time) : 0; }
Time TimeOf(int64_t micros) { return Time(duration_cast<Time::duration>(microseconds(micros))); }
std::optional<Time> OptionalTime(int64_t micros) {
  return micros == 0 ? std::nullopt : std::optional(TimeOf(micros));
}

// Columns are read in the order in which the SELECTs below name them; braces keep that order.
void Read(SqliteQuery& query, UploadRow& row) {
  row = {.tenant = query.Text(),
         .name = query.Text(),
         .declaration = query.Text(),
         .size_bytes = static_cast<uint64_t>(query.Number()),
         .job = query.Text(),
         .volume = query.Text(),
         .used = TimeOf(query.Number())};
}

void Read(SqliteQuery& query, VolumeRow& row) {
  row = {.tenant = query.Text(),
         .name = query.Text(),
         .declaration = query.Text(),
         .blob_digest = query.Text(),
         .volume_digest = query.Text(),
         .size_bytes = static_cast<uint64_t>(query.Number()),
         .created = TimeOf(query.Number()),
         .used = TimeOf(query.Number())};
}

void Read(SqliteQuery& query, ResultRow& row) {
  row = {.number = query.Number(),
         .tenant = query.Text(),
         .key = query.Text(),
         .file = query.Text(),
         .file_digest = query.Text(),
         .bytes = static_cast<uint64_t>(query.Number()),
         .records = static_cast<uint64_t>(query.Number()),
         .summary = query.Text()};
}

void Read(SqliteQuery& query, JobRow& row) {
  row = {.number = query.Number(),
         .tenant = query.Text(),
         .name = query.Text(),
         .request_id = query.Text(),
         .body = query.Text(),
         .upload = query.Text(),
         .options = query.Text(),
         .priority = static_cast<int>(query.Number()),
         .threads = static_cast<int>(query.Number()),
         .trace = query.Text(),
         .created = TimeOf(query.Number()),
         .volume = query.Text(),
         .state = static_cast<JobState>(query.Number()),
         .attempts = static_cast<int>(query.Number()),
         .crashes = static_cast<int>(query.Number()),
         .sequence = static_cast<uint64_t>(query.Number()),
         .owner = query.Text(),
         .error = StatusOfBytes(query.Text()),
         .result = query.Number(),
         .started = OptionalTime(query.Number()),
         .ended = OptionalTime(query.Number())};
}

void Read(SqliteQuery& query, EventRow& row) {
  row = {.job = query.Number(),
         .sequence = static_cast<uint64_t>(query.Number()),
         .time = TimeOf(query.Number()),
         .state = static_cast<JobState>(query.Number()),
         .attempt = static_cast<int>(query.Number()),
         .error = StatusOfBytes(query.Text())};
}

void Read(SqliteQuery& query, std::string& text) { text = query.Text(); }

#define BCCSKEL_UPLOAD_COLUMNS "tenant, name, declaration, size_bytes, job, volume, used"
#define BCCSKEL_VOLUME_COLUMNS \
  "tenant, name, declaration, blob_digest, volume_digest, size_bytes, created, used"
#define BCCSKEL_RESULT_COLUMNS "number, tenant, key, file, file_digest, bytes, records, summary"
#define BCCSKEL_JOB_COLUMNS                                                            \
  "number, tenant, name, request_id, body, upload, options, priority, threads, trace," \
  "created, volume, state, attempts, crashes, sequence, owner, error, result, started, ended"
#define BCCSKEL_EVENT_COLUMNS "job, sequence, time, state, attempt, error"

class SqliteJobStore final : public JobStore {
 public:
  explicit SqliteJobStore(std::unique_ptr<SqliteDatabase> database)
      : database_(std::move(database)) {}

  absl::Status Begin() override { return Run("BEGIN IMMEDIATE"); }
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
    return Run("INSERT INTO uploads(" BCCSKEL_UPLOAD_COLUMNS ") VALUES(?, ?, ?, ?, ?, ?, ?)",
               row.tenant, row.name, Blob{row.declaration}, Number(row.size_bytes), row.job,
               row.volume, Micros(row.used));
  }
  absl::Status UpdateUpload(const UploadRow& row) override {
    return Run("UPDATE uploads SET volume = ?, used = ? WHERE tenant = ? AND name = ?", row.volume,
               Micros(row.used), row.tenant, row.name);
  }
  absl::Status DeleteUpload(const std::string& tenant, const std::string& name) override {
    return Run("DELETE FROM uploads WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::optional<UploadRow>> FindUpload(const std::string& tenant,
                                                      const std::string& name) override {
    return One<UploadRow>("SELECT " BCCSKEL_UPLOAD_COLUMNS
                          " FROM uploads WHERE tenant = ? AND name = ?",
                          tenant, name);
  }
  absl::StatusOr<std::vector<UploadRow>> AllUploads() override {
    return All<UploadRow>("SELECT " BCCSKEL_UPLOAD_COLUMNS " FROM uploads");
  }

  absl::Status PutVolume(const VolumeRow& row) override {
    return Run("INSERT OR REPLACE INTO volumes(" BCCSKEL_VOLUME_COLUMNS
               ") VALUES(?, ?, ?, ?, ?, ?, ?, ?)",
               row.tenant, row.name, Blob{row.declaration}, row.blob_digest, row.volume_digest,
               Number(row.size_bytes), Micros(row.created), Micros(row.used));
  }
  absl::Status DeleteVolume(const std::string& tenant, const std::string& name) override {
    BCCSKEL_RETURN_IF_ERROR(
        Run("DELETE FROM uploads WHERE tenant = ? AND volume = ? AND volume != ''", tenant, name));
    return Run("DELETE FROM volumes WHERE tenant = ? AND name = ?", tenant, name);
  }
  absl::StatusOr<std::optional<VolumeRow>> FindVolume(const std::string& tenant,
                                                      const std::string& name) override {
    return One<VolumeRow>("SELECT " BCCSKEL_VOLUME_COLUMNS
                          " FROM volumes WHERE tenant = ? AND name = ?",
                          tenant, name);
  }
  absl::StatusOr<std::vector<VolumeRow>> FindVolumesOf(const std::string& tenant,
                                                       const std::string& digest) override {
    return All<VolumeRow>("SELECT " BCCSKEL_VOLUME_COLUMNS
                          " FROM volumes WHERE tenant = ?1 AND"
                          " (blob_digest = ?2 OR volume_digest = ?2) ORDER BY name",
                          tenant, digest);
  }
  absl::StatusOr<std::vector<VolumeRow>> AllVolumes() override {
    return All<VolumeRow>("SELECT " BCCSKEL_VOLUME_COLUMNS " FROM volumes");
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
    return database_->LastRow();
  }
  absl::StatusOr<bool> UpdateJob(const JobRow& row) override {
    BCCSKEL_RETURN_IF_ERROR(
        Run("UPDATE jobs SET volume = ?, state = ?, attempts = ?, crashes = ?, sequence = ?,"
            " owner = ?, error = ?, result = ?, started = ?, ended = ?"
            " WHERE number = ? AND state < 3",
            row.volume, Number(row.state), int64_t{row.attempts}, int64_t{row.crashes},
            Number(row.sequence), row.owner, Blob{BytesOf(row.error)}, row.result,
            Micros(row.started), Micros(row.ended), row.number));
    return database_->Changes() == 1;
  }
  absl::Status DeleteJob(int64_t number) override {
    return Run("DELETE FROM jobs WHERE number = ?", number);
  }
  absl::StatusOr<std::optional<JobRow>> FindJob(const std::string& tenant,
                                                const std::string& name) override {
    return One<JobRow>("SELECT " BCCSKEL_JOB_COLUMNS " FROM jobs WHERE tenant = ? AND name = ?",
                       tenant, name);
  }
  absl::StatusOr<std::optional<JobRow>> FindJobOfRequest(const std::string& tenant,
                                                         const std::string& request_id) override {
    return One<JobRow>("SELECT " BCCSKEL_JOB_COLUMNS
                       " FROM jobs WHERE tenant = ? AND request_id = ? AND request_id != ''",
                       tenant, request_id);
  }
  absl::StatusOr<std::vector<JobRow>> ListJobs(const std::string& tenant,
                                               const std::optional<JobPosition>& after,
                                               uint32_t states, int most) override {
    const int64_t created = after.has_value() ? Micros(after->created) : kNeverMicros;
    const std::string name = after.has_value() ? after->name : std::string();
    return All<JobRow>("SELECT " BCCSKEL_JOB_COLUMNS
                       " FROM jobs WHERE tenant = ? AND (created, name) < (?, ?)"
                       " AND (1 << state) & ? != 0 ORDER BY created DESC, name DESC LIMIT ?",
                       tenant, created, name, int64_t{states}, int64_t{most});
  }
  absl::StatusOr<std::vector<JobRow>> UnfinishedJobs() override {
    return All<JobRow>("SELECT " BCCSKEL_JOB_COLUMNS " FROM jobs WHERE state < 3 ORDER BY number");
  }
  absl::StatusOr<std::vector<JobRow>> JobsEndedBefore(Time time) override {
    return All<JobRow>("SELECT " BCCSKEL_JOB_COLUMNS
                       " FROM jobs WHERE state >= 3 AND ended < ? ORDER BY ended LIMIT 1000",
                       Micros(time));
  }
  absl::StatusOr<std::optional<std::string>> UserOfVolume(const std::string& tenant,
                                                          const std::string& volume) override {
    return One<std::string>(
        "SELECT name FROM jobs WHERE state < 3 AND tenant = ? AND volume = ? LIMIT 1", tenant,
        volume);
  }

  absl::Status InsertEvent(const EventRow& row) override {
    return Run("INSERT INTO events(" BCCSKEL_EVENT_COLUMNS ") VALUES(?, ?, ?, ?, ?, ?)", row.job,
               Number(row.sequence), Micros(row.time), Number(row.state), int64_t{row.attempt},
               Blob{BytesOf(row.error)});
  }
  absl::StatusOr<std::vector<EventRow>> EventsAfter(int64_t job, uint64_t sequence) override {
    return All<EventRow>("SELECT " BCCSKEL_EVENT_COLUMNS
                         " FROM events WHERE job = ? AND sequence > ? ORDER BY sequence",
                         job, Number(sequence));
  }

  absl::StatusOr<int64_t> InsertResult(const ResultRow& row) override {
    BCCSKEL_ASSIGN_OR_RETURN(const std::optional<ResultRow> found,
                             FindResultOf(row.tenant, row.key));
    if (found.has_value()) return found->number;
    BCCSKEL_RETURN_IF_ERROR(
        Run("INSERT INTO results(tenant, key, file, file_digest, bytes, records, summary)"
            " VALUES(?, ?, ?, ?, ?, ?, ?)",
            row.tenant, row.key, row.file, row.file_digest, Number(row.bytes), Number(row.records),
            Blob{row.summary}));
    return database_->LastRow();
  }
  absl::StatusOr<std::optional<ResultRow>> FindResult(int64_t number) override {
    return One<ResultRow>("SELECT " BCCSKEL_RESULT_COLUMNS " FROM results WHERE number = ?",
                          number);
  }
  absl::StatusOr<std::optional<ResultRow>> FindResultOf(const std::string& tenant,
                                                        const std::string& key) override {
    return One<ResultRow>(
        "SELECT " BCCSKEL_RESULT_COLUMNS " FROM results WHERE tenant = ? AND key = ?", tenant, key);
  }
  absl::StatusOr<std::optional<ResultRow>> TakeResultIfUnused(int64_t number) override {
    return One<ResultRow>(
        "DELETE FROM results WHERE number = ?1 AND NOT EXISTS"
        " (SELECT 1 FROM jobs WHERE result = ?1 AND result != 0)"
        " RETURNING " BCCSKEL_RESULT_COLUMNS,
        number);
  }
  absl::StatusOr<std::vector<ResultRow>> AllResults() override {
    return All<ResultRow>("SELECT " BCCSKEL_RESULT_COLUMNS " FROM results");
  }

  absl::Status Forget() override { return database_->Execute("PRAGMA wal_checkpoint(TRUNCATE)"); }

 private:
  template <typename... Values>
  absl::Status Run(const char* sql, const Values&... values) {
    return SqliteQuery(*database_, sql, values...).Run();
  }
  template <typename Row, typename... Values>
  absl::StatusOr<std::optional<Row>> One(const char* sql, const Values&... values) {
    SqliteQuery query(*database_, sql, values...);
    BCCSKEL_ASSIGN_OR_RETURN(const bool found, query.Next());
    if (!found) return std::nullopt;
    std::optional<Row> row(std::in_place);
    Read(query, *row);
    return row;
  }
  template <typename Row, typename... Values>
  absl::StatusOr<std::vector<Row>> All(const char* sql, const Values&... values) {
    SqliteQuery query(*database_, sql, values...);
    std::vector<Row> rows;
    while (true) {
      BCCSKEL_ASSIGN_OR_RETURN(const bool found, query.Next());
      if (!found) return rows;
      Read(query, rows.emplace_back());
    }
  }

  const std::unique_ptr<SqliteDatabase> database_;
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
