#ifndef BCCSKEL_CORE_DISTANCE_CHAMFER_WEIGHTS_H_
#define BCCSKEL_CORE_DISTANCE_CHAMFER_WEIGHTS_H_

#include <array>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace bccskel {

// Spacing along x, y and z relative to the smallest of the three, so at least 1. Ratios above
// kMaxSpacingRatio count as that.
using AxisScale = std::array<double, 3>;
inline constexpr AxisScale kIsotropic = {1, 1, 1};
inline constexpr double kMaxSpacingRatio = 10'000;
AxisScale AxisScaleOf(const Placement& placement);

// World units in a lattice unit: half the shortest edge of the cubic cell.
double WorldUnitsPerLatticeUnit(const Placement& placement);

// Local distances of the steps in fixed-point counts.
struct ChamferWeights {
  uint32_t diagonal = 0;               // D8
  std::array<uint32_t, 3> axial = {};  // D6, along x, y and z
  double counts_per_unit = 1;          // counts per lattice unit

  friend constexpr bool operator==(const ChamferWeights&, const ChamferWeights&) = default;
};

// For equal spacing: sqrt(3) and 2 lattice units (section 4). Rounds like the real weights up to a
// distance of 627 lattice units, which fits 16 bits.
inline constexpr ChamferWeights kShortChamfer = {181, {209, 209, 209}, 104.5};
// The same up to 4200 lattice units and more, in 32 bits.
inline constexpr ChamferWeights kLongChamfer = {2521, {2911, 2911, 2911}, 1455.5};

// The lengths of the steps as integers of the given size, at the resolution that best preserves
// their ratios. For equal spacing, kShortChamfer and kLongChamfer.
ChamferWeights ShortWeights(const AxisScale& scale);
ChamferWeights LongWeights(const AxisScale& scale);

// The largest ratio of a chamfer distance with real weights to the Euclidean one: 1.239 for equal
// spacing. The smallest is 1.
double LargestOverestimate(const AxisScale& scale);

// The same steps in the unit that makes the largest errors above and below equal.
ChamferWeights WithOptimalUnit(ChamferWeights weights, const AxisScale& scale);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_CHAMFER_WEIGHTS_H_
