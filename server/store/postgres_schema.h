#ifndef BCCSKEL_SERVER_STORE_POSTGRES_SCHEMA_H_
#define BCCSKEL_SERVER_STORE_POSTGRES_SCHEMA_H_

#include "absl/status/status.h"
#include "server/store/postgres_database.h"

namespace bccskel::server {

// The version of the tables that this program writes.
int PostgresSchemaVersion();

// Brings the tables to that version, in one transaction while no other server writes.
// Errors: FAILED_PRECONDITION for tables of a newer version.
absl::Status Migrate(PostgresDatabase& database);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_POSTGRES_SCHEMA_H_
