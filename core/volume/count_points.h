#ifndef BCCSKEL_CORE_VOLUME_COUNT_POINTS_H_
#define BCCSKEL_CORE_VOLUME_COUNT_POINTS_H_

#include <cstdint>
#include <span>

#include "core/volume/brick.h"

namespace bccskel {

// The number of set bits. Counted in registers: one by one, each word would cost a call into the
// compiler's library, which may not assume that the processor can count bits.
uint64_t CountPoints(std::span<const BrickBits> bricks);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_COUNT_POINTS_H_
