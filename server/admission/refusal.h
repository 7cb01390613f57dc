#ifndef BCCSKEL_SERVER_ADMISSION_REFUSAL_H_
#define BCCSKEL_SERVER_ADMISSION_REFUSAL_H_

#include <optional>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// Why a job was not let in. The service turns it into the details that callers see.
enum class Refusal {
  kVolumeTooLarge,       // more encoded bytes than the limit; RESOURCE_EXHAUSTED
  kTooManyBricks,        // a larger volume than the limit; RESOURCE_EXHAUSTED
  kShellPointsTooLarge,  // the points of the shells take more than was reserved; RESOURCE_EXHAUSTED
  kTooMuchMemory,        // more working memory than all jobs together may have; RESOURCE_EXHAUSTED
  kQueueFull,            // no place now; UNAVAILABLE
  kMemoryBusy,           // other jobs have the memory now; UNAVAILABLE
  kDraining,             // the server is about to stop; UNAVAILABLE
  kNoDecoder,            // no process, descriptor or memory for decoding now; UNAVAILABLE
};

// An error that remembers the reason. Its code is stated above.
absl::Status Refuse(Refusal refusal, const std::string& message);
std::optional<Refusal> RefusalOf(const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_REFUSAL_H_
