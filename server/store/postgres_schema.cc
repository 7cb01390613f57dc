#include <memory>
#include <string>
#include <utility>

#include "core/exec/status_macros.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"

namespace bccskel::server {
namespace {

constexpr int kVersion = 2;

// From the first release with durable jobs on, a change needs a migration from each released
// version. It only adds, with defaults: servers of the previous version continue with the tables of
// the next one until they are replaced.
//
// Text is stored as bytes, as callers sent it: it may hold a zero byte, and compares as in SQLite.
// The progress of running jobs is for watchers on other servers and may be lost.
constexpr char kPostgresTables[] = R"(
CREATE TABLE uploads(
  tenant BYTEA NOT NULL, name BYTEA NOT NULL, declaration BYTEA NOT NULL,
  size_bytes BIGINT NOT NULL, job BYTEA NOT NULL, volume BYTEA NOT NULL, used BIGINT NOT NULL,
  file BYTEA NOT NULL, row_check BIGINT NOT NULL DEFAULT 0, PRIMARY KEY(tenant, name));
CREATE TABLE volumes(
  tenant BYTEA NOT NULL, name BYTEA NOT NULL, declaration BYTEA NOT NULL,
  blob_digest BYTEA NOT NULL, volume_digest BYTEA NOT NULL, size_bytes BIGINT NOT NULL,
  created BIGINT NOT NULL, used BIGINT NOT NULL, row_check BIGINT NOT NULL DEFAULT 0,
  PRIMARY KEY(tenant, name));
CREATE INDEX volumes_by_blob ON volumes(tenant, blob_digest);
CREATE INDEX volumes_by_volume ON volumes(tenant, volume_digest);
CREATE TABLE results(
  number BIGSERIAL PRIMARY KEY, tenant BYTEA NOT NULL, key BYTEA NOT NULL, file BYTEA NOT NULL,
  file_digest BYTEA NOT NULL, bytes BIGINT NOT NULL, records BIGINT NOT NULL,
  summary BYTEA NOT NULL, row_check BIGINT NOT NULL DEFAULT 0, UNIQUE(tenant, key));
CREATE SEQUENCE job_changes;
CREATE TABLE jobs(
  number BIGSERIAL PRIMARY KEY, tenant BYTEA NOT NULL, name BYTEA NOT NULL,
  request_id BYTEA NOT NULL, body BYTEA NOT NULL, upload BYTEA NOT NULL, options BYTEA NOT NULL,
  priority BIGINT NOT NULL, threads BIGINT NOT NULL, trace BYTEA NOT NULL,
  created BIGINT NOT NULL, volume BYTEA NOT NULL, state INTEGER NOT NULL, attempts BIGINT NOT NULL,
  crashes BIGINT NOT NULL, sequence BIGINT NOT NULL, owner BYTEA NOT NULL, error BYTEA NOT NULL,
  result BIGINT NOT NULL, started BIGINT NOT NULL, ended BIGINT NOT NULL,
  row_check BIGINT NOT NULL DEFAULT 0, changed BIGINT NOT NULL DEFAULT nextval('job_changes'),
  UNIQUE(tenant, name));
CREATE UNIQUE INDEX jobs_by_request ON jobs(tenant, request_id) WHERE request_id != '';
CREATE INDEX jobs_by_creation ON jobs(tenant, created, name);
CREATE INDEX jobs_unfinished ON jobs(number) WHERE state < 3;
CREATE INDEX jobs_by_result ON jobs(result) WHERE result != 0;
CREATE INDEX jobs_by_end ON jobs(ended) WHERE state >= 3;
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
CREATE TABLE events(
  job BIGINT NOT NULL REFERENCES jobs(number) ON DELETE CASCADE, sequence BIGINT NOT NULL,
  time BIGINT NOT NULL, state INTEGER NOT NULL, attempt BIGINT NOT NULL, error BYTEA NOT NULL,
  row_check BIGINT NOT NULL DEFAULT 0, PRIMARY KEY(job, sequence));
CREATE TABLE removals(
  kind BIGINT NOT NULL, tenant BYTEA NOT NULL, name BYTEA NOT NULL,
  row_check BIGINT NOT NULL DEFAULT 0, PRIMARY KEY(kind, tenant, name));
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
  BCCSKEL_RETURN_IF_ERROR(database.Execute(kPostgresTables));
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
