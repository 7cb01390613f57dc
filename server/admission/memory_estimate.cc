#include "server/admission/memory_estimate.h"

#include <algorithm>

#include "server/admission/saturating.h"

namespace bccskel::server {
namespace {

uint64_t PipelineBytes(uint64_t bricks) {
  return SaturatingMultiply(bricks, kPipelineBytesPerBrick);
}

}  // namespace

uint64_t BytesToSkeletonize(const VolumeHeader& declared, uint64_t size_bytes,
                            ShellPointsWanted shell_points) {
  const uint64_t received = SaturatingAdd(declared.DecodingBytes(size_bytes), kFixedJobBytes);
  return SaturatingAdd(SaturatingAdd(received, PipelineBytes(declared.max_bricks)),
                       ShellPointsBytes(shell_points, declared.max_bricks));
}

uint64_t BytesToSkeletonize(const Volume& volume, ShellPointsWanted shell_points) {
  return kFixedJobBytes + PipelineBytes(volume.brick_count()) +
         ShellPointsBytes(shell_points, volume.brick_count());
}

int ThreadsFor(uint64_t bricks, int wanted, int threads) {
  if (bricks <= kSmallJobBricks) return 1;
  return ThreadsWithin(threads, wanted);
}

int ThreadsWithin(int threads, int wanted) {
  return wanted > 0 ? std::min(wanted, threads) : threads;
}

}  // namespace bccskel::server
