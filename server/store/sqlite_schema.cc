#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"
#include "server/store/table_definitions.h"

namespace bccskel::server {
namespace {

constexpr char kStoreTable[] =
    "CREATE TABLE store(id TEXT NOT NULL, schema_check INTEGER NOT NULL);"
    "INSERT INTO store VALUES(lower(hex(randomblob(16))), 0);";

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
      database.Execute(absl::StrCat("BEGIN IMMEDIATE;", kTables, kStoreTable, kSealSchema,
                                    "PRAGMA user_version = ", kSqliteSchemaVersion, "; COMMIT;"));
  if (!created.ok() && database.InTransaction()) database.Execute("ROLLBACK").IgnoreError();
  return created;
}

absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<SqlDatabase> database, OpenSqlite(path));
  BCCSKEL_RETURN_IF_ERROR(PrepareSqlite(*database));
  // Also allocates the tables' space before the disk is full.
  database->BeginUse();
  return std::make_unique<JobStore>(std::move(database));
}

#ifndef BCCSKEL_WITH_POSTGRESQL
absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string&) {
  return absl::UnimplementedError("this program was built without PostgreSQL (libpq)");
}
#endif

}  // namespace bccskel::server
