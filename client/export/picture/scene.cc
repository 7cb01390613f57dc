#include "client/export/picture/scene.h"

#include <algorithm>
#include <cmath>

#include "client/export/picture/surface_points.h"

namespace bccskel::exporting {
namespace {

void Include(view::WorldBox& box, const WorldPoint& p, double pad) {
  for (size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(box.low[axis], p[axis] - pad);
    box.high[axis] = std::max(box.high[axis], p[axis] + pad);
  }
}

}  // namespace

Scene SceneOf(const Subject& subject) {
  const Placement& placement = subject.object.placement();
  Scene scene;
  scene.point_spacing = *std::ranges::max_element(placement.spacing) * std::sqrt(3.0) / 2;
  for (const LatticePoint p : SurfacePoints(subject.object)) {
    scene.surface.push_back(placement.ToWorld(p));
  }
  if (scene.surface.empty()) scene.surface.push_back(placement.origin);
  scene.box = {scene.surface.front(), scene.surface.front()};
  // By the same amount along all axes, so that the broadest side stays the broadest.
  for (const WorldPoint& p : scene.surface) Include(scene.box, p, placement.spacing[2] / 2);
  scene.curves = DisplayCurvesOf(subject.result.graph);
  scene.radii = RadiusRangeOf(subject.result.graph);
  return scene;
}

}  // namespace bccskel::exporting
