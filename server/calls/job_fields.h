#ifndef BCCSKEL_SERVER_CALLS_JOB_FIELDS_H_
#define BCCSKEL_SERVER_CALLS_JOB_FIELDS_H_

#include "absl/status/statusor.h"
#include "bccskel/v1/job_service.pb.h"
#include "server/durable/ledger.h"

namespace bccskel::server {

// What callers of JobService send, as the ledger takes it. Errors: INVALID_ARGUMENT with the field.
absl::StatusOr<Ledger::NewJob> NewJobOf(const v1::CreateJobRequest& request);
absl::StatusOr<Ledger::JobQuery> QueryOf(const v1::ListJobsRequest& request);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_JOB_FIELDS_H_
