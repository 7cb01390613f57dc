#ifndef BCCSKEL_SERVER_DECODING_DECODING_BUDGET_H_
#define BCCSKEL_SERVER_DECODING_DECODING_BUDGET_H_

#include <chrono>
#include <cstdint>

#include "core/io/volume_header.h"

namespace bccskel::server {

// What decoding one volume may cost a child.
struct DecodingBudget {
  uint64_t memory_bytes = 0;               // beside what the child has before the volume
  std::chrono::seconds processor_time{0};  // in the child
  std::chrono::seconds wall_time{0};       // until the last byte of its reply
};

// Several times what a well-formed volume with this header takes: whoever needs more means harm.
DecodingBudget BudgetFor(const VolumeHeader& header, uint64_t encoded_bytes);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_DECODING_BUDGET_H_
