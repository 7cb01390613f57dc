#ifndef BCCSKEL_CORE_VOLUME_COUNT_POINTS_H_
#define BCCSKEL_CORE_VOLUME_COUNT_POINTS_H_

#include <cstdint>
#include <span>

#include "core/volume/brick.h"

namespace bccskel {

// The number of set bits, counted in vector registers: counting word by word would call into the
// compiler's library for each, since the baseline instruction set has no population count.
uint64_t CountPoints(std::span<const BrickBits> bricks);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_COUNT_POINTS_H_
