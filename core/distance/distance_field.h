#ifndef BCCSKEL_CORE_DISTANCE_DISTANCE_FIELD_H_
#define BCCSKEL_CORE_DISTANCE_DISTANCE_FIELD_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include "absl/status/statusor.h"
#include "core/distance/chamfer_weights.h"
#include "core/exec/context.h"
#include "core/exec/uninitialized.h"
#include "core/volume/volume.h"

namespace bccskel {

// How the distance of a point to the background is measured. All kinds are in lattice units, half
// the shortest edge of the cubic cell, so distances of an anisotropic placement are those in the
// world.
enum class DistanceKind : uint8_t {
  // Shortest digital paths with the real lengths of their steps (section 4): 0 to 24 % too long.
  kChamfer,
  // The same paths with optimal local distances: at most 11 % off, either way.
  kChamferOptimal,
  // Straight distances.
  kEuclidean,
};

// Distance of every point of a volume's bricks to the nearest background point; 0 for background
// points.
// Shapes: values() has kBrickPoints entries per brick, in bit order, and as many for the padding
//         brick.
class DistanceField {
 public:
  // Chamfer distances are counts, in 16 bits unless some distance needs more. Euclidean ones are
  // squared lattice units: 16 bits where the spacing is the same along all axes and no distance
  // needs more, else floats.
  using Values =
      std::variant<exec::UninitializedVector<uint16_t>, exec::UninitializedVector<uint32_t>,
                   exec::UninitializedVector<float>>;

  DistanceField(DistanceKind kind, ChamferWeights weights, Values values, uint32_t largest)
      : kind_(kind), weights_(weights), values_(std::move(values)), largest_(largest) {}

  DistanceKind kind() const { return kind_; }
  // For chamfer distances only.
  const ChamferWeights& weights() const { return weights_; }
  const Values& values() const { return values_; }
  Values TakeValues() && { return std::move(values_); }

  // A number that increases with the distance: its counts, its square, or the bits of the float
  // that holds the square. Equal if and only if the distances are equal.
  uint32_t At(BrickIndex brick, int bit) const {
    const size_t n = size_t{brick} * kBrickPoints + static_cast<size_t>(bit);
    return std::visit([n](const auto& v) { return RankOf(v[n]); }, values_);
  }
  // The squared distance in lattice units. For Euclidean distances only.
  float SquareAt(BrickIndex brick, int bit) const {
    const size_t n = size_t{brick} * kBrickPoints + static_cast<size_t>(bit);
    return std::visit([n](const auto& v) { return static_cast<float>(v[n]); }, values_);
  }
  uint32_t largest() const { return largest_; }  // At() of the deepest point

  // `rank` as from At().
  double ToLatticeUnits(uint32_t rank) const {
    if (kind_ != DistanceKind::kEuclidean) return rank / weights_.counts_per_unit;
    const bool is_float = std::holds_alternative<exec::UninitializedVector<float>>(values_);
    return std::sqrt(is_float ? std::bit_cast<float>(rank) : static_cast<double>(rank));
  }

  static uint32_t RankOf(uint16_t counts) { return counts; }
  static uint32_t RankOf(uint32_t counts) { return counts; }
  static uint32_t RankOf(float squared) { return std::bit_cast<uint32_t>(squared); }

 private:
  DistanceKind kind_;
  ChamferWeights weights_;
  Values values_;
  uint32_t largest_;
};

// Errors: CANCELLED, DEADLINE_EXCEEDED.
// Cost:   chamfer: two raster scans over the occupied bricks; Euclidean: see euclidean_scan.cc.
// Threads: uses the context's; the result is the same for any number and any instruction set.
absl::StatusOr<DistanceField> ComputeDistance(const Volume& object, DistanceKind kind,
                                              const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_DISTANCE_FIELD_H_
