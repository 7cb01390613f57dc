#include <iterator>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"

namespace bccskel::server {
namespace {

// Migration n upgrades a file from version n to version n + 1. Released migrations never change.
constexpr const char* kSqliteMigrations[] = {
    // 1
    R"(
CREATE TABLE uploads(
  tenant TEXT NOT NULL, name TEXT NOT NULL, declaration BLOB NOT NULL, size_bytes INTEGER NOT NULL,
  job TEXT NOT NULL, volume TEXT NOT NULL, used INTEGER NOT NULL,
  PRIMARY KEY(tenant, name)) WITHOUT ROWID;
CREATE TABLE volumes(
  tenant TEXT NOT NULL, name TEXT NOT NULL, declaration BLOB NOT NULL, blob_digest TEXT NOT NULL,
  volume_digest TEXT NOT NULL, size_bytes INTEGER NOT NULL, created INTEGER NOT NULL,
  used INTEGER NOT NULL,
  PRIMARY KEY(tenant, name)) WITHOUT ROWID;
CREATE INDEX volumes_by_blob ON volumes(tenant, blob_digest);
CREATE INDEX volumes_by_volume ON volumes(tenant, volume_digest);
CREATE TABLE results(
  number INTEGER PRIMARY KEY AUTOINCREMENT, tenant TEXT NOT NULL, key TEXT NOT NULL,
  file TEXT NOT NULL, file_digest TEXT NOT NULL, bytes INTEGER NOT NULL, records INTEGER NOT NULL,
  summary BLOB NOT NULL, UNIQUE(tenant, key));
CREATE TABLE jobs(
  number INTEGER PRIMARY KEY AUTOINCREMENT, tenant TEXT NOT NULL, name TEXT NOT NULL,
  request_id TEXT NOT NULL, body BLOB NOT NULL, upload TEXT NOT NULL, options BLOB NOT NULL,
  priority INTEGER NOT NULL, created INTEGER NOT NULL, volume TEXT NOT NULL,
  state INTEGER NOT NULL, attempts INTEGER NOT NULL, crashes INTEGER NOT NULL,
  sequence INTEGER NOT NULL, owner TEXT NOT NULL, error BLOB NOT NULL, result INTEGER NOT NULL,
  started INTEGER NOT NULL, ended INTEGER NOT NULL, UNIQUE(tenant, name));
CREATE UNIQUE INDEX jobs_by_request ON jobs(tenant, request_id) WHERE request_id != '';
CREATE INDEX jobs_by_tenant ON jobs(tenant, number);
CREATE INDEX jobs_unfinished ON jobs(number) WHERE state < 3;
CREATE INDEX jobs_by_result ON jobs(result) WHERE result != 0;
CREATE TABLE events(
  job INTEGER NOT NULL REFERENCES jobs(number) ON DELETE CASCADE, sequence INTEGER NOT NULL,
  time INTEGER NOT NULL, state INTEGER NOT NULL, attempt INTEGER NOT NULL, error BLOB NOT NULL,
  PRIMARY KEY(job, sequence)) WITHOUT ROWID;
)",
    // 2: the number of threads that a job requests; jobs that end first expire first.
    R"(
ALTER TABLE jobs ADD COLUMN threads INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_by_end ON jobs(ended) WHERE state >= 3;
)",
    // 3: job lists use only what their tenant may know.
    R"(
DROP INDEX jobs_by_tenant;
CREATE INDEX jobs_by_creation ON jobs(tenant, created, name);
)",
    // 4: the trace of a job.
    R"(
ALTER TABLE jobs ADD COLUMN trace TEXT NOT NULL DEFAULT '';
)",
    // 5: a checksum for every row, the store's own id, and files to be deleted.
    R"(
ALTER TABLE uploads ADD COLUMN row_check INTEGER NOT NULL DEFAULT 0;
UPDATE uploads SET row_check = checksum('uploads', tenant, name, declaration, size_bytes, job,
  volume, used);
ALTER TABLE volumes ADD COLUMN row_check INTEGER NOT NULL DEFAULT 0;
UPDATE volumes SET row_check = checksum('volumes', tenant, name, declaration, blob_digest,
  volume_digest, size_bytes, created, used);
ALTER TABLE results ADD COLUMN row_check INTEGER NOT NULL DEFAULT 0;
UPDATE results SET row_check = checksum('results', number, tenant, key, file, file_digest, bytes,
  records, summary);
ALTER TABLE jobs ADD COLUMN row_check INTEGER NOT NULL DEFAULT 0;
UPDATE jobs SET row_check = checksum('jobs', number, tenant, name, request_id, body, upload,
  options, priority, threads, trace, created, volume, state, attempts, crashes, sequence, owner,
  error, result, started, ended);
ALTER TABLE events ADD COLUMN row_check INTEGER NOT NULL DEFAULT 0;
UPDATE events SET row_check = checksum('events', job, sequence, time, state, attempt, error);
CREATE TABLE removals(
  kind INTEGER NOT NULL, tenant TEXT NOT NULL, name TEXT NOT NULL,
  row_check INTEGER NOT NULL DEFAULT 0, PRIMARY KEY(kind, tenant, name)) WITHOUT ROWID;
CREATE TABLE store(id TEXT NOT NULL, schema_check INTEGER NOT NULL);
INSERT INTO store VALUES(lower(hex(randomblob(16))), 0);
)",
    // 6: an upload names its file.
    R"(
ALTER TABLE uploads ADD COLUMN file TEXT NOT NULL DEFAULT '';
UPDATE uploads SET row_check = checksum('uploads', tenant, name, declaration, size_bytes, job,
  volume, used, file);
)",
};

// The definitions of all tables and indexes.
#define BCCSKEL_SCHEMA_CHECK                                                        \
  "(SELECT sum(checksum(type, name, tbl_name, ifnull(sql, ''))) FROM sqlite_master" \
  " WHERE name NOT LIKE 'sqlite_%')"
constexpr char kSealSchema[] = "UPDATE store SET schema_check = " BCCSKEL_SCHEMA_CHECK ";";

absl::StatusOr<int> VersionOf(SqlDatabase& database) {
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, database.Run("PRAGMA user_version", {}));
  return static_cast<int>(rows.front().Number());
}

absl::Status Damaged(const std::string& how) {
  return absl::DataLossError(absl::StrCat(
      "the job store is damaged: ", how, "; nothing was changed: bring back a copy of the folder"));
}

// Checks the pages, and that indexes match their tables: a row missing from an index is not found.
absl::Status CheckIntegrity(SqlDatabase& database) {
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, database.Run("PRAGMA integrity_check(1)", {}));
  const std::string answer = rows.front().Text();
  return answer == "ok" ? absl::OkStatus() : Damaged(answer);
}

absl::Status CheckSchema(SqlDatabase& database) {
  static constexpr char kCheck[] = "SELECT schema_check = " BCCSKEL_SCHEMA_CHECK " FROM store";
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, database.Run(kCheck, {}));
  const bool whole = !rows.empty() && rows.front().Number() == 1;
  return whole ? absl::OkStatus() : Damaged("its tables are defined wrongly");
}

}  // namespace

absl::Status CheckSchemaVersion(int version, int known) {
  if (version <= known) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat("the job store has version ", version,
                                                    ", this server knows versions up to ", known,
                                                    ": it was written by a newer server"));
}

int SqliteSchemaVersion() { return static_cast<int>(std::size(kSqliteMigrations)); }

absl::Status MigrateSqlite(SqlDatabase& database) {
  BCCSKEL_ASSIGN_OR_RETURN(int version, VersionOf(database));
  BCCSKEL_RETURN_IF_ERROR(CheckSchemaVersion(version, SqliteSchemaVersion()));
  BCCSKEL_RETURN_IF_ERROR(CheckIntegrity(database));
  for (; version < SqliteSchemaVersion(); ++version) {
    const bool last = version + 1 == SqliteSchemaVersion();
    const std::string sql =
        absl::StrCat("BEGIN IMMEDIATE;", kSqliteMigrations[version], last ? kSealSchema : "",
                     "PRAGMA user_version = ", version + 1, "; COMMIT;");
    absl::Status migrated = database.Execute(sql);
    if (migrated.ok()) continue;
    if (database.InTransaction()) database.Execute("ROLLBACK").IgnoreError();
    return migrated;
  }
  return CheckSchema(database);
}

absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<SqlDatabase> database, OpenSqlite(path));
  BCCSKEL_RETURN_IF_ERROR(MigrateSqlite(*database));
  // Allocates the tables' space before the disk is full; on a disk that is full already this fails.
  database->Forget().IgnoreError();
  return std::make_unique<JobStore>(std::move(database));
}

#ifndef BCCSKEL_WITH_POSTGRESQL
absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string&) {
  return absl::UnimplementedError("this program was built without PostgreSQL (libpq)");
}
#endif

}  // namespace bccskel::server
