#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_replace.h"
#include "core/exec/status_macros.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"
#include "server/store/table_definitions.h"

namespace bccskel::server {
namespace {

constexpr int kVersion = 3;

// A migration only adds, with defaults: servers of the previous version continue with the tables of
// the next one until they are replaced.
//
// Text is stored as bytes, as callers sent it: it may hold a zero byte, and compares as in SQLite.
std::string PostgresTables() {
  return absl::StrReplaceAll(kTables,
                             {{" INTEGER PRIMARY KEY AUTOINCREMENT", " BIGSERIAL PRIMARY KEY"},
                              {" INTEGER ", " BIGINT "},
                              {" TEXT ", " BYTEA "},
                              {" BLOB ", " BYTEA "},
                              {" WITHOUT ROWID", ""}});
}

// The progress of running jobs is for watchers on other servers and may be lost.
constexpr char kFleetTables[] = R"(
CREATE SEQUENCE job_changes;
ALTER TABLE jobs ADD COLUMN changed BIGINT NOT NULL DEFAULT nextval('job_changes');
CREATE INDEX jobs_by_change ON jobs(changed);
CREATE TABLE deleted_jobs(
  changed BIGINT PRIMARY KEY DEFAULT nextval('job_changes'), number BIGINT NOT NULL,
  at TIMESTAMPTZ NOT NULL DEFAULT now());
CREATE FUNCTION note_job_change() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF TG_OP = 'DELETE' THEN
    INSERT INTO deleted_jobs(number) VALUES(OLD.number);
    RETURN OLD;
  END IF;
  NEW.changed := nextval('job_changes');
  RETURN NEW;
END $$;
CREATE TRIGGER job_changed BEFORE UPDATE OR DELETE ON jobs
  FOR EACH ROW EXECUTE FUNCTION note_job_change();
CREATE TABLE servers(
  server BYTEA PRIMARY KEY, beats BIGINT NOT NULL, since TIMESTAMPTZ NOT NULL DEFAULT now());
CREATE UNLOGGED TABLE progress(
  job BIGINT PRIMARY KEY REFERENCES jobs(number) ON DELETE CASCADE, sequence BIGINT NOT NULL,
  bytes BYTEA NOT NULL);
)";

constexpr char kVersionTable[] =
    "CREATE TABLE IF NOT EXISTS store(id BYTEA NOT NULL, version BIGINT NOT NULL);"
    "INSERT INTO store SELECT convert_to(replace(gen_random_uuid()::text, '-', ''), 'UTF8'), 0"
    " WHERE NOT EXISTS (SELECT 1 FROM store);";

absl::Status PrepareWithin(SqlDatabase& database) {
  BCCSKEL_RETURN_IF_ERROR(database.Execute(kVersionTable));
  BCCSKEL_ASSIGN_OR_RETURN(auto rows, database.Run("SELECT version FROM store", {}));
  const auto version = static_cast<int>(rows.front().Number());
  if (version != 0) return CheckSchemaVersion(version, kVersion);
  BCCSKEL_RETURN_IF_ERROR(database.Execute(PostgresTables() + kFleetTables));
  return database.Run("UPDATE store SET version = $1", {SqlValue::Number(kVersion)}).status();
}

}  // namespace

absl::Status PreparePostgres(SqlDatabase& database) {
  BCCSKEL_RETURN_IF_ERROR(database.Begin(""));
  absl::Status prepared = PrepareWithin(database);
  if (prepared.ok()) return database.Execute("COMMIT");
  if (database.InTransaction()) database.Execute("ROLLBACK").IgnoreError();
  return prepared;
}

absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string& name) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<SqlDatabase> database, OpenPostgres(name));
  BCCSKEL_RETURN_IF_ERROR(PreparePostgres(*database));
  return std::make_unique<JobStore>(std::move(database));
}

}  // namespace bccskel::server
