#ifndef BCCSKEL_SERVER_STORE_TABLE_DEFINITIONS_H_
#define BCCSKEL_SERVER_STORE_TABLE_DEFINITIONS_H_

namespace bccskel::server {

// The tables of both databases in the SQL of SQLite. From the first release with durable jobs on, a
// change needs a migration from each released version.
inline constexpr char kTables[] = R"(
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
)";

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_TABLE_DEFINITIONS_H_
