#ifndef BCCSKEL_SERVER_STORE_SCHEMA_H_
#define BCCSKEL_SERVER_STORE_SCHEMA_H_

#include "absl/status/status.h"
#include "server/store/sql_database.h"

namespace bccskel::server {

// The version of the tables that this program writes. A file of SQLite states its own as
// user_version, 0 when it is new.
int SqliteSchemaVersion();

// Bring the tables to the version that this program writes: a file one version after the other,
// each in a transaction; a shared database in one, while no other server writes. Errors:
// FAILED_PRECONDITION for a newer version; DATA_LOSS for a damaged file.
absl::Status MigrateSqlite(SqlDatabase& database);
absl::Status MigratePostgres(SqlDatabase& database);

// Errors: FAILED_PRECONDITION for tables of a version that this program, which knows those up to
//         `known`, does not.
absl::Status CheckSchemaVersion(int version, int known);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SCHEMA_H_
