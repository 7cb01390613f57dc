#include "core/pruning/bumps.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/pruning/thin_set.h"

namespace bccskel {
namespace {

constexpr int kMajority = 7;  // points with fewer object neighbors are bumps
constexpr int kThinner = 3;   // in thin limbs: with so many fewer than the median

}  // namespace

void Bumps::SetLimb(std::span<const LatticePoint> limb, bool has_point) {
  least_ = 0;
  if (has_point) return;
  std::vector<int> counts;
  for (LatticePoint p : limb) counts.push_back(object_.NeighborsOf(p));
  least_ =
      std::clamp(static_cast<int>(MedianOf(std::move(counts))) - kThinner, kThinner, kMajority);
}

size_t Bumps::LastFirm(std::span<const LatticePoint> limb) {
  size_t last = limb.size() - 1;
  while (last > 0 && !IsFirm(limb[last])) --last;
  return last;
}

}  // namespace bccskel
