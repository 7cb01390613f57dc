#ifndef BCCSKEL_CORE_PIPELINE_BIRTHS_H_
#define BCCSKEL_CORE_PIPELINE_BIRTHS_H_

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/skeleton/skeleton_graph.h"
#include "core/thinning/thinning.h"
#include "core/volume/volume.h"

namespace bccskel {

// 0 if the point never was an isthmus.
inline int32_t BirthOf(LatticePoint p, const std::vector<IsthmusBirth>& isthmuses) {
  const auto found = std::ranges::lower_bound(isthmuses, p, {}, &IsthmusBirth::point);
  return found != isthmuses.end() && found->point == p ? found->pass : 0;
}

inline void SetBirths(const std::vector<IsthmusBirth>& isthmuses, SkeletonGraph& graph) {
  if (isthmuses.empty()) return;
  for (SkeletonNode& node : graph.nodes) node.at.birth = BirthOf(node.at.point, isthmuses);
  for (SkeletonPoint& p : graph.points) p.birth = BirthOf(p.point, isthmuses);
  for (SkeletonPoint& p : graph.sheets) p.birth = BirthOf(p.point, isthmuses);
}

// In the order of Volume::ForEachPoint(). Shapes: `isthmuses` in lattice order.
inline std::vector<int32_t> BirthsOf(const Volume& thin,
                                     const std::vector<IsthmusBirth>& isthmuses) {
  std::vector<int32_t> births;
  thin.ForEachPoint([&](LatticePoint p) { births.push_back(BirthOf(p, isthmuses)); });
  return births;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_BIRTHS_H_
