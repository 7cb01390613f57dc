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
  const float* known = known_.Find(p);
  return known != nullptr ? *known : NearestRecent(p).distance;
}

FirmDepth::Recent FirmDepth::NearestRecent(LatticePoint p) const {
  Recent nearest = {kOutside, std::numeric_limits<float>::infinity()};
  for (LatticePoint q : lately_) {
    if (q == kOutside) continue;
    const float distance = radius_.Between(p, q);
    if (distance < nearest.distance) nearest = {q, distance};
  }
  return nearest;
}

// Knowing a point that is no pit, each search visits few bricks.
float FirmDepth::Search(LatticePoint p) {
  const Recent recent = NearestRecent(p);
  const auto search = [&] {
    if (recent.at != kOutside) radius_.StartFrom(recent.at);
    return radius_.At(p);
  };
  float depth = search();
  while (radius_.has_nearest() && IsPit(radius_.nearest())) {
    radius_.TakeFromBackground(radius_.nearest());
    depth = search();
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
