#include "core/pipeline/thin_points.h"

#include <algorithm>

#include "core/pruning/point_table.h"

namespace bccskel {
namespace {

// 0 if the point never was an isthmus.
int32_t BirthOf(LatticePoint p, const std::vector<IsthmusBirth>& isthmuses) {
  const auto found = std::ranges::lower_bound(isthmuses, p, {}, &IsthmusBirth::point);
  return found != isthmuses.end() && found->point == p ? found->pass : 0;
}

}  // namespace

void SetBirths(const std::vector<IsthmusBirth>& isthmuses, SkeletonGraph& graph) {
  if (isthmuses.empty()) return;
  for (SkeletonNode& node : graph.nodes) node.at.birth = BirthOf(node.at.point, isthmuses);
  for (SkeletonPoint& p : graph.points) p.birth = BirthOf(p.point, isthmuses);
  for (SkeletonPoint& p : graph.sheets) p.birth = BirthOf(p.point, isthmuses);
}

std::vector<int32_t> BirthsOf(const Volume& thin, const std::vector<IsthmusBirth>& isthmuses) {
  std::vector<int32_t> births;
  thin.ForEachPoint([&](LatticePoint p) { births.push_back(BirthOf(p, isthmuses)); });
  return births;
}

void SetRadii(const std::vector<float>& radii, const Volume& thin, SkeletonGraph& graph) {
  PointTable<float> by_point;
  by_point.Reserve(radii.size());
  size_t n = 0;
  thin.ForEachPoint([&](LatticePoint p) { by_point.Set(p, radii[n++]); });
  for (SkeletonPoint& p : graph.points) p.radius = *by_point.Find(p.point);
}

}  // namespace bccskel
