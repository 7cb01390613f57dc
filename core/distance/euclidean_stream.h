#ifndef BCCSKEL_CORE_DISTANCE_EUCLIDEAN_STREAM_H_
#define BCCSKEL_CORE_DISTANCE_EUCLIDEAN_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"

namespace bccskel {

// Receives squared distances brick by brick, in any order.
// Threads: Take() is called on several workers at once, for different bricks.
class SquareSink {
 public:
  virtual ~SquareSink() = default;

  // Shapes: kBrickPoints in bit order. A brick may come again; its last squares count.
  virtual void Take(BrickIndex brick, const uint16_t* squares) = 0;
  virtual void Take(BrickIndex brick, const float* squares) = 0;
};

// Whether the distance field is kept in memory.
enum class KeepField : uint8_t {
  kAlways,
  // If it takes 2 bytes per point, or has at most kMostFloatsKept values: a field pays for long
  // curves.
  kIfSmall,
};
inline constexpr size_t kMostFloatsKept = size_t{1} << 24;

// Above this number of lattice points, objects are measured in parts. A part takes a tenth more
// time per point than the whole, but only its own squares are in memory, beside the shell planes of
// the other parts.
inline constexpr size_t kMostSquaresAtOnce = size_t{1} << 21;

// Streams the distances of ComputeDistance() for kEuclidean (euclidean_scan.cc). Objects with more
// than `at_once` lattice points are measured column by column of bricks. `sink` may be null.
// Cost:   4.8 bytes per lattice point of the bricks that are measured together, 9 if they are too
//         deep for 16 bits or the spacings differ.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::optional<DistanceField>> StreamEuclidean(const Volume& object,
                                                             const exec::Context& context,
                                                             SquareSink* sink, KeepField keep,
                                                             size_t at_once = kMostSquaresAtOnce);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_STREAM_H_
