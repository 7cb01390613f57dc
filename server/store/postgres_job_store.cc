#include "core/exec/status_macros.h"
#include "server/store/postgres_database.h"
#include "server/store/postgres_schema.h"
#include "server/store/sql_job_store.h"

namespace bccskel::server {

absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string& database) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<PostgresDatabase> opened,
                           PostgresDatabase::Open(database));
  BCCSKEL_RETURN_IF_ERROR(Migrate(*opened));
  return MakeSqlJobStore(std::move(opened));
}

}  // namespace bccskel::server
