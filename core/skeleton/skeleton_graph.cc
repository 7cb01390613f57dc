#include "core/skeleton/skeleton_graph.h"

#include <algorithm>

namespace bccskel {

double SkeletonGraph::RadiusOf(const SkeletonPoint& p) const {
  return p.radius * std::ranges::min(placement.spacing) / 2;
}

bool SkeletonGraph::HasBirths() const {
  const auto is_born = [](const SkeletonPoint& p) { return p.birth > 0; };
  return std::ranges::any_of(points, is_born);
}

}  // namespace bccskel
