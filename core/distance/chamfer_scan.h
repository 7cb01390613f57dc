#ifndef BCCSKEL_CORE_DISTANCE_CHAMFER_SCAN_H_
#define BCCSKEL_CORE_DISTANCE_CHAMFER_SCAN_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"
#include "core/exec/uninitialized.h"

namespace bccskel {

// ComputeDistance() for kChamfer and kChamferOptimal.
absl::StatusOr<DistanceField> ComputeChamfer(const Volume& object, DistanceKind kind,
                                             const exec::Context& context);

// Receives distances brick by brick, in any order, so that they need not all be in memory.
// Threads: Take() is called on several workers at once, for different bricks.
class DistanceSink {
 public:
  virtual ~DistanceSink() = default;

  // Starts again: distances received so far are void. Distances come in these counts, all below
  // `limit`.
  virtual void Begin(const ChamferWeights& weights, uint32_t limit) = 0;
  // Receives the distances of a brick. Shapes: kBrickPoints in bit order. Returns the largest.
  virtual uint32_t Take(BrickIndex brick, const uint16_t* distances) = 0;
  virtual uint32_t Take(BrickIndex brick, const uint32_t* distances) = 0;
};

// Above this number of lattice points, distances are not all in memory at once. On a ball of 67
// million points on fresh memory, sections take 0.4 to 0.6 s of processor time, all at once 0.7 to
// 0.8 s and twice the memory; while distances fit the cache, scanning twice only costs.
inline constexpr size_t kMostPointsAtOnce = size_t{1} << 24;

// Streams the distances of ComputeChamfer() to `sink`.
// Cost:   2 bytes per lattice point of the object's bricks, 4 for deep objects. Of objects with
//         more than `at_once` lattice points only some slabs of bricks have all distances at a
//         time, the others one layer; that repeats the first scan.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::Status StreamChamfer(const Volume& object, DistanceKind kind, const exec::Context& context,
                           DistanceSink& sink, size_t at_once = kMostPointsAtOnce);

// Passes layers of distances between the holders of an object that is cut into runs of brick
// layers, from the lowest to the highest and back. Each holder calls these four once per scan, in
// this order; the lowest takes nothing from below and the highest nothing from above.
class LayerRelay {
 public:
  using Bytes = exec::UninitializedVector<std::byte>;
  virtual ~LayerRelay() = default;

  virtual Bytes TakeFromBelow() = 0;
  virtual void GiveAbove(const Bytes& layer) = 0;
  virtual Bytes TakeFromAbove() = 0;
  virtual void GiveBelow(const Bytes& layer) = 0;
  // Returns the largest of all holders' numbers to each of them.
  virtual uint32_t Largest(uint32_t own) = 0;
};

// Brick layers [first, end).
struct HeldLayers {
  int32_t first = 0;
  int32_t end = std::numeric_limits<int32_t>::max();
};

// StreamChamfer() for one holder's layers: `object` holds their bricks and those of the layers
// below and above, which the sink does not receive. The holders scan one after the other.
// Errors: CANCELLED, DEADLINE_EXCEEDED if this holder has to stop; the results of the others, who
//         are not told, are then void.
absl::Status StreamChamferOfLayers(const Volume& object, const HeldLayers& held, DistanceKind kind,
                                   const exec::Context& context, DistanceSink& sink,
                                   LayerRelay& relay, size_t at_once = kMostPointsAtOnce);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_CHAMFER_SCAN_H_
