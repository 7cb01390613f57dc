#include "core/pruning/firm_depth.h"

#include <algorithm>
#include <limits>

namespace bccskel {
namespace {

constexpr LatticePoint kOutside = {-1, -1, -1};
constexpr int kFirmMajority = 8;  // of a background point's 14 neighbors and itself

}  // namespace

FirmDepth::FirmDepth(const Volume& object, const ExactRadius& radius)
    : bricks_(object), radius_(radius.searches() ? radius : ExactRadius(object)) {
  lately_.fill(kOutside);
}

float FirmDepth::At(LatticePoint p) {
  if (const float* known = known_.Find(p); known != nullptr) return *known;
  const float depth = Search(p);
  known_.Set(p, depth);
  return depth;
}

float FirmDepth::AtMost(LatticePoint p) const {
  if (const float* known = known_.Find(p); known != nullptr) return *known;
  float least = std::numeric_limits<float>::infinity();
  for (LatticePoint q : lately_) {
    if (q != kOutside) least = std::min(least, radius_.Between(p, q));
  }
  return least;
}

float FirmDepth::Search(LatticePoint p) {
  float depth = radius_.At(p);
  while (radius_.has_nearest() && IsPit(radius_.nearest())) {
    radius_.TakeFromBackground(radius_.nearest());
    depth = radius_.At(p);
  }
  if (radius_.has_nearest()) Remember(radius_.nearest());
  return depth;
}

bool FirmDepth::IsPit(LatticePoint q) { return bricks_.NeighborsOf(q) >= kFirmMajority; }

void FirmDepth::Remember(LatticePoint background) {
  lately_[oldest_] = background;
  oldest_ = (oldest_ + 1) % lately_.size();
}

}  // namespace bccskel
