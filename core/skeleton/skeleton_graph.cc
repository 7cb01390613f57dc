#include "core/skeleton/skeleton_graph.h"

#include <algorithm>

namespace bccskel {

double SkeletonGraph::RadiusOf(const SkeletonPoint& p) const {
  return p.radius * std::ranges::min(placement.spacing) / 2;
}

}  // namespace bccskel
