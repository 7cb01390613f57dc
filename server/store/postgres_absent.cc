#include "server/store/sql_job_store.h"

namespace bccskel::server {

absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string&) {
  return absl::UnimplementedError("this program was built without PostgreSQL (libpq)");
}

}  // namespace bccskel::server
