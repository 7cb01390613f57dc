#include "server/store/schema.h"

#include <iterator>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

// Migration n brings a file from version n to version n + 1. What was released is never changed.
constexpr const char* kMigrations[] = {
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
    // 2: the number of threads that a job wants; what ends first expires first.
    R"(
ALTER TABLE jobs ADD COLUMN threads INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_by_end ON jobs(ended) WHERE state >= 3;
)",
    // 3: jobs are listed by what their tenant may know.
    R"(
DROP INDEX jobs_by_tenant;
CREATE INDEX jobs_by_creation ON jobs(tenant, created, name);
)",
    // 4: the trace to which a job belongs.
    R"(
ALTER TABLE jobs ADD COLUMN trace TEXT NOT NULL DEFAULT '';
)",
};

absl::StatusOr<int> VersionOf(SqliteDatabase& database) {
  SqliteQuery query(database, "PRAGMA user_version");
  BCCSKEL_RETURN_IF_ERROR(query.Next().status());
  return static_cast<int>(query.Number());
}

absl::Status CheckIntegrity(SqliteDatabase& database) {
  SqliteQuery query(database, "PRAGMA quick_check(1)");
  BCCSKEL_RETURN_IF_ERROR(query.Next().status());
  const std::string answer = query.Text();
  if (answer == "ok") return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("the job store is damaged: ", answer));
}

}  // namespace

int SchemaVersion() { return static_cast<int>(std::size(kMigrations)); }

absl::Status Migrate(SqliteDatabase& database) {
  BCCSKEL_ASSIGN_OR_RETURN(int version, VersionOf(database));
  if (version > SchemaVersion()) {
    return absl::FailedPreconditionError(
        absl::StrCat("the job store has version ", version, ", this server knows versions up to ",
                     SchemaVersion(), ": it was written by a newer server"));
  }
  BCCSKEL_RETURN_IF_ERROR(CheckIntegrity(database));
  for (; version < SchemaVersion(); ++version) {
    const std::string sql = absl::StrCat("BEGIN IMMEDIATE;", kMigrations[version],
                                         "PRAGMA user_version = ", version + 1, "; COMMIT;");
    const absl::Status migrated = database.Execute(sql.c_str());
    if (migrated.ok()) continue;
    if (database.InTransaction()) database.Execute("ROLLBACK").IgnoreError();
    return migrated;
  }
  return absl::OkStatus();
}

}  // namespace bccskel::server
