#include "core/pruning/ridge_end.h"

#include <algorithm>

#include "core/pruning/limb_anchor.h"

namespace bccskel {
namespace {

constexpr double kTurnRadii = 0.75;
constexpr double kTurnMargin = 2;       // plus lattice units
constexpr double kBodyTurnRadii = 1.2;  // the same for bodies
constexpr double kBodySlope = 0.45;     // instead of kRidgeSlope
constexpr double kThickerBody = 1.4;    // least radius, in radii of the limb

// Position in the path of the last point up to which the depth falls by less than `slope` per unit
// of the path, wherever that leads.
size_t RidgeEndBy(double slope, const ThinSet& set, FirmDepth& depth, const LimbEnd& limb) {
  size_t best = limb.first;
  double length = 0, most = depth.At(limb.path[limb.first]);
  for (size_t n = limb.first + 1; n < limb.path.size(); ++n) {
    length += set.Between(limb.path[n - 1], limb.path[n]);
    const double merit = slope * length + depth.At(limb.path[n]);
    if (merit < most) continue;
    best = n;
    most = merit;
  }
  return best;
}

}  // namespace

std::optional<size_t> RidgeEndAside(const ThinSet& set, FirmDepth& depth, const LimbEnd& limb) {
  const size_t end = RidgeEndBy(kRidgeSlope, set, depth, limb);
  const double least = kTurnRadii * set.RadiusOf(limb.path[end]) + kTurnMargin;
  if (set.Between(limb.straight, limb.path[end]) > least) return end;
  const size_t body_end = RidgeEndBy(kBodySlope, set, depth, limb);
  const LatticePoint body =
      *std::ranges::max_element(limb.path.subspan(limb.first, body_end + 1 - limb.first), {},
                                [&](LatticePoint p) { return set.RadiusOf(p); });
  const double radius = set.RadiusOf(body);
  if (radius < kThickerBody * limb.radius) return std::nullopt;
  const double far = kBodyTurnRadii * radius + kTurnMargin;
  if (set.Between(body, limb.path[body_end]) < far) return std::nullopt;
  return body_end;
}

}  // namespace bccskel
