#include "core/exec/status_macros.h"
#include "server/store/schema.h"
#include "server/store/sql_job_store.h"
#include "server/store/sqlite_database.h"

namespace bccskel::server {

absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<SqliteDatabase> database, SqliteDatabase::Open(path));
  BCCSKEL_RETURN_IF_ERROR(Migrate(*database));
  // So that the tables have their room before the disk is full; where it is already, without.
  database->Forget().IgnoreError();
  return MakeSqlJobStore(std::move(database));
}

}  // namespace bccskel::server
