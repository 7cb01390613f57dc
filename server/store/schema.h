#ifndef BCCSKEL_SERVER_STORE_SCHEMA_H_
#define BCCSKEL_SERVER_STORE_SCHEMA_H_

#include "absl/status/status.h"
#include "server/store/sqlite_database.h"

namespace bccskel::server {

// The version that this program writes; the file states its own as SQLite's user_version, 0 when it
// is new.
int SchemaVersion();

// Brings the file to SchemaVersion(), one version after the other, each in a transaction.
// Errors: FAILED_PRECONDITION for a file of a newer version; DATA_LOSS for a damaged one.
absl::Status Migrate(SqliteDatabase& database);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SCHEMA_H_
