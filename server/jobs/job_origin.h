#ifndef BCCSKEL_SERVER_JOBS_JOB_ORIGIN_H_
#define BCCSKEL_SERVER_JOBS_JOB_ORIGIN_H_

#include <string>

namespace bccskel::server {

// Among the jobs of one tenant.
enum class JobPriority { kLow = -1, kNormal = 0, kHigh = 1 };

// Who asks, and how urgently: decides on turns and caps, never on results.
struct JobOrigin {
  std::string tenant;  // "": the one that all callers without a name share
  JobPriority priority = JobPriority::kNormal;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_JOB_ORIGIN_H_
