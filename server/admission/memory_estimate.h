#ifndef BCCSKEL_SERVER_ADMISSION_MEMORY_ESTIMATE_H_
#define BCCSKEL_SERVER_ADMISSION_MEMORY_ESTIMATE_H_

#include <cstddef>
#include <cstdint>

#include "core/io/volume_header.h"
#include "core/volume/volume.h"
#include "server/admission/saturating.h"

namespace bccskel::server {

// Volumes of up to so many occupied bricks (1 M points) get one thread: more would not make them
// faster, and eight of them side by side are better served.
inline constexpr uint64_t kSmallJobBricks = 2048;

// Memory of the pipeline per occupied brick. Peak resident memory of the server grew by 2.1 KiB a
// brick for a ball of 17 M points (70 k bricks, 16-bit distances); 32-bit distances, which objects
// wider than about 600 lattice units have, add 1 KiB; Euclidean ones take 4.3 KiB while they
// are made.
inline constexpr uint64_t kPipelineBytesPerBrick = 5120;
// Of a job: stacks, tables, chunks in flight and the allocator's slack.
inline constexpr uint64_t kFixedJobBytes = uint64_t{4} << 20;

// Whether the points that go with each shell are to be kept for the caller.
enum class ShellPointsWanted : uint8_t { kNone, kAll };

// Per brick, of the points of all shells as they are sent: 3 bytes for each of 512 points, whose
// neighbors in a brick are near, and 12 more for the first of a brick, in 64 shells.
inline constexpr uint64_t kShellPointsBytesPerBrick = 3 * 512 + 12 * 64;
constexpr uint64_t ShellPointsBytes(ShellPointsWanted wanted, uint64_t bricks) {
  if (wanted == ShellPointsWanted::kNone) return 0;
  return SaturatingMultiply(bricks, kShellPointsBytesPerBrick);
}

// Peak memory for receiving and decoding a volume that was declared like this, and for thinning it
// when every brick that it may have is occupied.
uint64_t BytesToSkeletonize(const VolumeHeader& declared, uint64_t size_bytes,
                            ShellPointsWanted shell_points = ShellPointsWanted::kNone);

// Peak memory for thinning this volume.
uint64_t BytesToSkeletonize(const Volume& volume,
                            ShellPointsWanted shell_points = ShellPointsWanted::kNone);

// `wanted` 0 leaves it to the server.
int ThreadsWithin(int threads, int wanted);

// Threads that a job of this size should get of `threads`. `wanted` 0 leaves it to the server.
int ThreadsFor(uint64_t bricks, int wanted, int threads);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_MEMORY_ESTIMATE_H_
