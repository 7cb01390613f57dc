#ifndef BCCSKEL_SERVER_STORE_SQLITE_JOB_STORE_H_
#define BCCSKEL_SERVER_STORE_SQLITE_JOB_STORE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/store/job_store.h"

namespace bccskel::server {

// The file is made or migrated to this program's version.
// Errors: FAILED_PRECONDITION for a file of a newer version; DATA_LOSS for a damaged one.
absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SQLITE_JOB_STORE_H_
