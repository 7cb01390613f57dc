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
  // If they take 2 bytes a point, or all lie in kMostFloatsKept lattice points: then they pay where
  // curves are long, and memory for planes of shells is as much.
  kIfSmall,
};
inline constexpr size_t kMostFloatsKept = size_t{1} << 24;

// Bricks that are measured together: many enough for several workers, few enough for caches.
inline constexpr size_t kBricksMeasuredAtOnce = 4096;

// The distances of ComputeDistance() for kEuclidean, measured column of bricks by column: see
// euclidean_scan.cc for how. `sink` may be null.
// Cost:   besides what stays, half a byte per lattice point of the object's bricks and 4.4 for those
//         of `at_once` bricks, 8.8 where columns are deeper than 16 bits or axes have different
//         spacings.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::optional<DistanceField>> StreamEuclidean(
    const Volume& object, const exec::Context& context, SquareSink* sink, KeepField keep,
    size_t at_once = kBricksMeasuredAtOnce);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_STREAM_H_
