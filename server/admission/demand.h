#ifndef BCCSKEL_SERVER_ADMISSION_DEMAND_H_
#define BCCSKEL_SERVER_ADMISSION_DEMAND_H_

#include <cstddef>
#include <cstdint>

#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel::server {

// Volumes of up to so many occupied bricks (1 M points) get one thread: more would not make them
// faster, and eight of them side by side are better served.
inline constexpr uint64_t kSmallJobBricks = 2048;

// Peak memory for receiving and decoding a volume that was declared like this, and for thinning it
// when every brick that it may have is occupied.
uint64_t BytesToSkeletonize(const VolumeHeader& declared, uint64_t size_bytes);

// Peak memory for thinning this volume.
uint64_t BytesToSkeletonize(const Volume& volume);

// Threads that a job of this size should get of `threads`. `wanted` 0 leaves it to the server.
int ThreadsFor(uint64_t bricks, int wanted, int threads);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_DEMAND_H_
