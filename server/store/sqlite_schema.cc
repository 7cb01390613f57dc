#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"

namespace bccskel::server {
namespace {

// From the first release with durable jobs on, a change needs a migration from each released
// version.
constexpr char kSqliteTables[] = R"(
CREATE TABLE uploads(
  tenant TEXT NOT NULL, name TEXT NOT NULL, declaration BLOB NOT NULL, size_bytes INTEGER NOT NULL,
  job TEXT NOT NULL, volume TEXT NOT NULL, used INTEGER NOT NULL, file TEXT NOT NULL,
  row_check INTEGER NOT NULL DEFAULT 0, PRIMARY KEY(tenant, name)) WITHOUT ROWID;
CREATE TABLE volumes(
  tenant TEXT NOT NULL, name TEXT NOT NULL, declaration BLOB NOT NULL, blob_digest TEXT NOT NULL,
  volume_digest TEXT NOT NULL, size_bytes INTEGER NOT NULL, created INTEGER NOT NULL,
  used INTEGER NOT NULL, row_check INTEGER NOT NULL DEFAULT 0,
  PRIMARY KEY(tenant, name)) WITHOUT ROWID;
CREATE INDEX volumes_by_blob ON volumes(tenant, blob_digest);
CREATE INDEX volumes_by_volume ON volumes(tenant, volume_digest);
CREATE TABLE results(
  number INTEGER PRIMARY KEY AUTOINCREMENT, tenant TEXT NOT NULL, key TEXT NOT NULL,
  file TEXT NOT NULL, file_digest TEXT NOT NULL, bytes INTEGER NOT NULL, records INTEGER NOT NULL,
  summary BLOB NOT NULL, row_check INTEGER NOT NULL DEFAULT 0, UNIQUE(tenant, key));
CREATE TABLE jobs(
  number INTEGER PRIMARY KEY AUTOINCREMENT, tenant TEXT NOT NULL, name TEXT NOT NULL,
  request_id TEXT NOT NULL, body BLOB NOT NULL, upload TEXT NOT NULL, options BLOB NOT NULL,
  priority INTEGER NOT NULL, threads INTEGER NOT NULL, trace TEXT NOT NULL,
  created INTEGER NOT NULL, volume TEXT NOT NULL, state INTEGER NOT NULL,
  attempts INTEGER NOT NULL, crashes INTEGER NOT NULL, sequence INTEGER NOT NULL,
  owner TEXT NOT NULL, error BLOB NOT NULL, result INTEGER NOT NULL, started INTEGER NOT NULL,
  ended INTEGER NOT NULL, row_check INTEGER NOT NULL DEFAULT 0, UNIQUE(tenant, name));
CREATE UNIQUE INDEX jobs_by_request ON jobs(tenant, request_id) WHERE request_id != '';
CREATE INDEX jobs_by_creation ON jobs(tenant, created, name);
CREATE INDEX jobs_unfinished ON jobs(number) WHERE state < 3;
CREATE INDEX jobs_by_result ON jobs(result) WHERE result != 0;
CREATE INDEX jobs_by_end ON jobs(ended) WHERE state >= 3;
CREATE TABLE events(
  job INTEGER NOT NULL REFERENCES jobs(number) ON DELETE CASCADE, sequence INTEGER NOT NULL,
  time INTEGER NOT NULL, state INTEGER NOT NULL, attempt INTEGER NOT NULL, error BLOB NOT NULL,
  row_check INTEGER NOT NULL DEFAULT 0, PRIMARY KEY(job, sequence)) WITHOUT ROWID;
CREATE TABLE removals(
  kind INTEGER NOT NULL, tenant TEXT NOT NULL, name TEXT NOT NULL,
  row_check INTEGER NOT NULL DEFAULT 0, PRIMARY KEY(kind, tenant, name)) WITHOUT ROWID;
CREATE TABLE store(id TEXT NOT NULL, schema_check INTEGER NOT NULL);
INSERT INTO store VALUES(lower(hex(randomblob(16))), 0);
)";

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

absl::Status CheckSchemaVersion(int version, int needed) {
  if (version == needed) return absl::OkStatus();
  const std::string what =
      absl::StrCat("the job store has version ", version, ", this server needs version ", needed);
  return absl::FailedPreconditionError(
      version > needed
          ? absl::StrCat(what, ": it was written by a newer server; start that one")
          : absl::StrCat(what, ": it was written by a server older than any release that stores ",
                         "jobs; fetch the results with that one, then start with an empty ",
                         "--data-dir, and an empty database if there is a --job-store"));
}

absl::Status PrepareSqlite(SqlDatabase& database) {
  BCCSKEL_ASSIGN_OR_RETURN(const int version, VersionOf(database));
  if (version != 0) BCCSKEL_RETURN_IF_ERROR(CheckSchemaVersion(version, kSqliteSchemaVersion));
  BCCSKEL_RETURN_IF_ERROR(CheckIntegrity(database));
  if (version != 0) return CheckSchema(database);
  absl::Status created =
      database.Execute(absl::StrCat("BEGIN IMMEDIATE;", kSqliteTables, kSealSchema,
                                    "PRAGMA user_version = ", kSqliteSchemaVersion, "; COMMIT;"));
  if (!created.ok() && database.InTransaction()) database.Execute("ROLLBACK").IgnoreError();
  return created;
}

absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<SqlDatabase> database, OpenSqlite(path));
  BCCSKEL_RETURN_IF_ERROR(PrepareSqlite(*database));
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
