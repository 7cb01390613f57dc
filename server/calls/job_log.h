#ifndef BCCSKEL_SERVER_CALLS_JOB_LOG_H_
#define BCCSKEL_SERVER_CALLS_JOB_LOG_H_

#include "server/store/rows.h"

namespace bccskel::server {

// A line for a state that a durable job has come into.
void LogJobState(const JobRow& job);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_JOB_LOG_H_
