#include "tests/core/prepare/reference_prepare.h"

#include <algorithm>
#include <set>

#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"

namespace bccskel::test {
namespace {

// All that can be reached from `start` by steps to points that pass.
template <typename Passes>
std::set<LatticePoint> Flood(LatticePoint start, Passes passes) {
  std::set<LatticePoint> reached = {start};
  std::vector<LatticePoint> open = {start};
  while (!open.empty()) {
    const LatticePoint p = open.back();
    open.pop_back();
    for (LatticePoint step : kDirections14) {
      const LatticePoint q = p + step;
      if (passes(q) && reached.insert(q).second) open.push_back(q);
    }
  }
  return reached;
}

}  // namespace

Points Sorted(Points points) {
  std::ranges::sort(points);
  return points;
}

Points ReferenceFilled(const Points& points) {
  const ReferencePointSet object(points);
  LatticePoint corner;
  bool found = false;
  object.ForEachLatticePointOfBox([&](LatticePoint p) {
    if (!found) corner = p;
    found = true;
  });
  const auto outside =
      Flood(corner, [&](LatticePoint p) { return object.InBox(p) && !object.Contains(p); });
  Points filled;
  object.ForEachLatticePointOfBox([&](LatticePoint p) {
    if (!outside.contains(p)) filled.push_back(p);
  });
  return Sorted(filled);
}

std::vector<Points> ReferenceComponents(const Points& points) {
  const ReferencePointSet object(points);
  std::vector<Points> components;
  std::set<LatticePoint> seen;
  for (LatticePoint start : points) {
    if (seen.contains(start)) continue;
    const auto component = Flood(start, [&](LatticePoint p) { return object.Contains(p); });
    seen.insert(component.begin(), component.end());
    components.emplace_back(component.begin(), component.end());
  }
  return components;
}

Points ReferenceDenoised(const Points& points) {
  const ReferencePointSet object(points);
  Points denoised;
  object.ForEachLatticePointOfBox([&](LatticePoint p) {
    int neighbors = 0;
    for (LatticePoint step : kDirections14) neighbors += object.Contains(p + step) ? 1 : 0;
    if (neighbors >= (object.Contains(p) ? 7 : 8)) denoised.push_back(p);
  });
  return Sorted(denoised);
}

BettiNumbers BettiOf(const Volume& object) { return ReferenceBetti(ReferencePointSet(object)); }

}  // namespace bccskel::test
