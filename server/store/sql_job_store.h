#ifndef BCCSKEL_SERVER_STORE_SQL_JOB_STORE_H_
#define BCCSKEL_SERVER_STORE_SQL_JOB_STORE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"

namespace bccskel::server {

// A job store in a database that has its tables.
std::unique_ptr<JobStore> MakeSqlJobStore(std::unique_ptr<SqlDatabase> database);

// A job store in a file of SQLite, which is made where it does not exist.
// Errors: FAILED_PRECONDITION for a file of a newer version; DATA_LOSS for a damaged one.
absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path);

// A job store in a PostgreSQL database, named by a URL or libpq's words. Its tables are made where
// they do not exist, by one server of those that come at the same time.
// Errors: INVALID_ARGUMENT for a name that libpq does not understand, or that has a password in it;
//         FAILED_PRECONDITION for tables of a newer version; UNAVAILABLE; UNIMPLEMENTED in a
//         program that was built without libpq.
absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string& database);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SQL_JOB_STORE_H_
