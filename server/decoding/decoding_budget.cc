#include "server/decoding/decoding_budget.h"

namespace bccskel::server {
namespace {

// Measured: 200 MB/s for ZIP, 500 for RLE; sanitizers and old machines take ten times as long.
constexpr uint64_t kSlowestBytesPerSecond = uint64_t{16} << 20;
// The allocator's slack, and vectors that double while they grow.
constexpr uint64_t kSlackBytes = uint64_t{64} << 20;

}  // namespace

DecodingBudget BudgetFor(const VolumeHeader& header, uint64_t encoded_bytes) {
  const std::chrono::seconds processor(2 + header.decoded_bytes / kSlowestBytesPerSecond);
  return {.memory_bytes = kSlackBytes + 2 * header.DecodingBytes(encoded_bytes),
          .processor_time = processor,
          // The processors may be busy with other jobs.
          .wall_time = std::chrono::seconds(30) + 8 * processor};
}

}  // namespace bccskel::server
