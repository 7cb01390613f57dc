#include "server/admission/demand.h"

#include <algorithm>
#include <limits>

namespace bccskel::server {
namespace {

// Memory of the pipeline per occupied brick. Peak resident memory of the server grew by 2.1 KiB a
// brick for a ball of 17 M points (70 k bricks, 16-bit distances); 32-bit distances, which objects
// wider than about 600 lattice units have, add 1 KiB; Euclidean ones take 4.3 KiB while they are
// made.
constexpr uint64_t kPipelineBytesPerBrick = 5120;
// Stacks, tables, chunks in flight and the allocator's slack.
constexpr uint64_t kFixedBytes = uint64_t{4} << 20;

uint64_t SaturatingAdd(uint64_t a, uint64_t b) {
  uint64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? std::numeric_limits<uint64_t>::max() : sum;
}

uint64_t PipelineBytes(uint64_t bricks) {
  uint64_t bytes = 0;
  return __builtin_mul_overflow(bricks, kPipelineBytesPerBrick, &bytes)
             ? std::numeric_limits<uint64_t>::max()
             : bytes;
}

}  // namespace

uint64_t BytesToSkeletonize(const VolumeHeader& declared, uint64_t size_bytes) {
  return SaturatingAdd(SaturatingAdd(declared.DecodingBytes(size_bytes), kFixedBytes),
                       PipelineBytes(declared.max_bricks));
}

uint64_t BytesToSkeletonize(const Volume& volume) {
  return kFixedBytes + PipelineBytes(volume.brick_count());
}

int ThreadsFor(uint64_t bricks, int wanted, int threads) {
  if (bricks <= kSmallJobBricks) return 1;
  return wanted > 0 ? std::min(wanted, threads) : threads;
}

}  // namespace bccskel::server
