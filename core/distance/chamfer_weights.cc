#include "core/distance/chamfer_weights.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace bccskel {
namespace {

// Lengths of a D8 step and of the D6 steps along x, y and z, in lattice units.
struct StepLengths {
  double diagonal;
  std::array<double, 3> axial;
};
StepLengths LengthsOf(const AxisScale& s) {
  return {std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]), {2 * s[0], 2 * s[1], 2 * s[2]}};
}

struct RoundedWeights {
  ChamferWeights weights;
  double error = 0;  // the largest relative one
};

RoundedWeights Round(const StepLengths& lengths, uint32_t counts_in_two_units) {
  RoundedWeights rounded;
  const double unit = counts_in_two_units / 2.0;
  const auto counts = [&](double length) {
    const double whole = std::floor(length * unit + 0.5);
    rounded.error = std::max(rounded.error, std::abs(whole / (length * unit) - 1));
    return static_cast<uint32_t>(whole);
  };
  rounded.weights.diagonal = counts(lengths.diagonal);
  for (size_t axis = 0; axis < 3; ++axis) rounded.weights.axial[axis] = counts(lengths.axial[axis]);
  rounded.weights.counts_per_unit = unit;
  return rounded;
}

// The best resolution between most / 2 and `most` counts in two lattice units.
ChamferWeights BestWeights(const AxisScale& scale, uint32_t most) {
  const StepLengths lengths = LengthsOf(scale);
  RoundedWeights best = Round(lengths, most);
  for (uint32_t counts = most - 1; 2 * counts >= most; --counts) {
    const RoundedWeights rounded = Round(lengths, counts);
    if (rounded.error < best.error) best = rounded;
  }
  return best.weights;
}

}  // namespace

AxisScale AxisScaleOf(const Placement& placement) {
  const double smallest = std::ranges::min(placement.spacing);
  AxisScale scale;
  for (size_t axis = 0; axis < 3; ++axis) {
    scale[axis] = std::min(placement.spacing[axis] / smallest, kMaxSpacingRatio);
  }
  return scale;
}

double WorldUnitsPerLatticeUnit(const Placement& placement) {
  return std::ranges::min(placement.spacing) / 2;
}

ChamferWeights ShortWeights(const AxisScale& scale) {
  return BestWeights(scale, kShortChamfer.axial[0]);
}
ChamferWeights LongWeights(const AxisScale& scale) {
  return BestWeights(scale, kLongChamfer.axial[0]);
}

// The chamfer distance of v is the largest n.v over all n for which no step is longer than its
// weight, so its largest ratio to |v| is the largest |n|. With weights that are lengths: |n_i| <= 1
// and sum of |n_i| scale_i <= diagonal; the longest such n fill their components one after the
// other.
double LargestOverestimate(const AxisScale& scale) {
  std::array<size_t, 3> order = {0, 1, 2};
  double longest = 0;
  do {
    double left = LengthsOf(scale).diagonal, squared = 0;
    for (size_t axis : order) {
      const double n = std::min(1.0, left / scale[axis]);
      left -= n * scale[axis];
      squared += n * n;
    }
    longest = std::max(longest, std::sqrt(squared));
  } while (std::next_permutation(order.begin(), order.end()));
  return longest;
}

// Errors are between 0 and M - 1; in a unit (1 + M) / 2 as long they are between 2 / (1 + M) - 1
// and the opposite.
ChamferWeights WithOptimalUnit(ChamferWeights weights, const AxisScale& scale) {
  weights.counts_per_unit *= (1 + LargestOverestimate(scale)) / 2;
  return weights;
}

}  // namespace bccskel
