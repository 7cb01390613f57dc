#include "core/skeleton/skeleton_graph.h"

#include <algorithm>

namespace bccskel {

double SkeletonGraph::RadiusOf(const SkeletonPoint& p) const {
  return p.radius * std::ranges::min(placement.spacing) / 2;
}

bool SkeletonGraph::HasShifts() const {
  const auto is_shifted = [](const SkeletonPoint& p) {
    return p.shift != std::array<int16_t, 3>{0, 0, 0};
  };
  return std::ranges::any_of(points, is_shifted);
}

bool SkeletonGraph::HasBirths() const {
  const auto is_born = [](const SkeletonPoint& p) { return p.birth > 0; };
  return std::ranges::any_of(points, is_born) || std::ranges::any_of(sheets, is_born) ||
         std::ranges::any_of(nodes, is_born, &SkeletonNode::at);
}

}  // namespace bccskel
