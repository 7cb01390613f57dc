#ifndef BCCSKEL_CORE_DISTANCE_CHAMFER_DISTANCE_H_
#define BCCSKEL_CORE_DISTANCE_CHAMFER_DISTANCE_H_

#include <cstdint>
#include <span>
#include <variant>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/exec/uninitialized.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel {

// Local distances of the two kinds of steps in fixed-point counts; `unit` counts are one lattice
// unit, so a D8 step is diagonal / unit = sqrt(3) and a D6 step axial / unit = 2 (section 4).
struct ChamferWeights {
  uint32_t diagonal;    // D8
  uint32_t axial;       // D6
  uint32_t half_units;  // counts in two lattice units; the same as `axial`

  friend constexpr bool operator==(const ChamferWeights&, const ChamferWeights&) = default;
};
// Rounds as the real weights sqrt(3) and 2 do up to a distance of 627 lattice units; 16 bits hold
// it.
inline constexpr ChamferWeights kShortChamfer = {181, 209, 209};
// The same up to 4200 lattice units and beyond, in 32 bits.
inline constexpr ChamferWeights kLongChamfer = {2521, 2911, 2911};

// Chamfer distance between two points, in counts.
// Source: "Distance transforms for three-dimensional grids with non-cubic voxels", 2005: with
//         |x| >= |y| >= |z| the shortest path has |y| D8 steps and (|x| - |y|) / 2 D6 steps.
uint32_t ChamferBetween(LatticePoint a, LatticePoint b, const ChamferWeights& weights);

// Distance of every point of a volume's bricks to the background; 0 for background points.
// Shapes: values(brick) has kBrickPoints entries in bit order.
class ChamferField {
 public:
  // 16-bit values for kShortChamfer, 32-bit ones for kLongChamfer, which are used only if some
  // distance is 620 lattice units or more.
  using Values =
      std::variant<exec::UninitializedVector<uint16_t>, exec::UninitializedVector<uint32_t>>;

  ChamferField(ChamferWeights weights, Values values, uint32_t largest)
      : weights_(weights), values_(std::move(values)), largest_(largest) {}

  const ChamferWeights& weights() const { return weights_; }
  const Values& values() const { return values_; }
  uint32_t At(BrickIndex brick, int bit) const {
    const size_t n = size_t{brick} * kBrickPoints + static_cast<size_t>(bit);
    return std::visit([n](const auto& v) { return static_cast<uint32_t>(v[n]); }, values_);
  }
  uint32_t largest() const { return largest_; }
  double ToLatticeUnits(uint32_t counts) const { return 2.0 * counts / weights_.half_units; }

 private:
  ChamferWeights weights_;
  Values values_;
  uint32_t largest_;
};

// Errors: CANCELLED, DEADLINE_EXCEEDED.
// Cost:   two raster scans over the occupied bricks.
absl::StatusOr<ChamferField> ComputeChamferDistance(const Volume& object,
                                                    const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_CHAMFER_DISTANCE_H_
