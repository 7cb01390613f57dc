#ifndef BCCSKEL_SERVER_JOBS_OUT_OF_MEMORY_H_
#define BCCSKEL_SERVER_JOBS_OUT_OF_MEMORY_H_

#include <new>
#include <system_error>

#include "absl/status/status.h"

namespace bccskel::server {

// Runs a step of a job; memory or threads that cannot be had are the job's error, not the server's
// end.
template <typename Step>
auto OrOutOfMemory(Step step) -> decltype(step()) {
  try {
    return step();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory although the job was admitted");
  } catch (const std::system_error& error) {
    return absl::ResourceExhaustedError(error.what());
  }
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_OUT_OF_MEMORY_H_
