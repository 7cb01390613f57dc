#include "core/pruning/last_limb.h"

#include <algorithm>
#include <limits>

#include "core/pruning/branch_walk.h"
#include "core/pruning/largest_run.h"
#include "core/pruning/prune.h"

namespace bccskel {
namespace {

constexpr double kBead = 1.4;  // least radius of a bead, in radii of the limb after it

}  // namespace

size_t LastLimb::BeginIn(const ThinSet& set, std::span<const LatticePoint> path, size_t first) {
  double most = std::numeric_limits<double>::infinity();
  for (size_t n = path.size() - 1; n-- > first;) {
    const double radius = set.RadiusOf(path[n]);
    if (radius > most) {
      if (SignificanceOf(set, path.subspan(n)) >= kDefaultSignificance) return n + 1;
      most = kBead * radius;  // the limb may begin farther back, behind a thicker bead
    } else if (SticksOut(set, path[n], path.back())) {
      most = std::min(most, kBead * radius);
    }
  }
  return first;
}

// By more than noise causes, so that SignificanceOf(), which is slower, is rarely called.
bool LastLimb::SticksOut(const ThinSet& set, LatticePoint root, LatticePoint tip) const {
  const double radius = set.RadiusOf(root), fallen = radius - set.RadiusOf(tip);
  const double allowance = noise_.Stretch(set.Way(root, tip)) * noise_.At(radius);
  return set.Between(root, tip) - kSteepness * fallen > allowance;
}

double LastLimb::SignificanceOf(const ThinSet& set, std::span<const LatticePoint> path) {
  if (!significance_.has_value()) significance_.emplace(object_, noise_).Share(balls_);
  return significance_->Of(set, {{path.rbegin(), path.rend() - 1}, path.front()});
}

}  // namespace bccskel
