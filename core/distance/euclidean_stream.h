#ifndef BCCSKEL_CORE_DISTANCE_EUCLIDEAN_STREAM_H_
#define BCCSKEL_CORE_DISTANCE_EUCLIDEAN_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"

namespace bccskel {

// Takes squared distances brick by brick, in any order, where they are measured.
// Threads: Take() is called on several workers at once, for different bricks.
class SquareSink {
 public:
  virtual ~SquareSink() = default;

  // Shapes: kBrickPoints in bit order, of the object's brick. A brick may come again: its last
  // squares count.
  virtual void Take(BrickIndex brick, const uint16_t* squares) = 0;
  virtual void Take(BrickIndex brick, const float* squares) = 0;
};

// Which distances stay.
enum class KeepField : uint8_t {
  kAlways,
  // If they take 2 bytes a point, or are kMostFloatsKept at most: they pay where curves are long.
  kIfSmall,
};
inline constexpr size_t kMostFloatsKept = size_t{1} << 24;

// More lattice points than this are measured in parts. A part costs a tenth more time per point
// than the whole, and has the planes of the other parts' shells beside it, not their squares.
inline constexpr size_t kMostSquaresAtOnce = size_t{1} << 21;

// The distances of ComputeDistance() for kEuclidean: see euclidean_scan.cc. Those of objects with
// more than `at_once` lattice points are measured column of bricks by column. `sink` may be null.
// Cost:   4.8 bytes per lattice point of the bricks that are measured together, 9 where they are
//         deeper than 16 bits or axes have different spacings.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::optional<DistanceField>> StreamEuclidean(const Volume& object,
                                                             const exec::Context& context,
                                                             SquareSink* sink, KeepField keep,
                                                             size_t at_once = kMostSquaresAtOnce);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_STREAM_H_
