#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_SCENE_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_SCENE_H_

#include <vector>

#include "client/export/picture/display_curve.h"
#include "client/export/picture/projection.h"
#include "client/export/subject.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::exporting {

// The contents of all views of a picture.
struct Scene {
  std::vector<WorldPoint> surface;  // at least one point
  view::WorldBox box;               // around the surface, larger by half a step along z
  double point_spacing;  // distance of D8 neighbors in world units, by the largest spacing
  std::vector<DisplayCurve> curves;
  RadiusRange radii;
};

Scene SceneOf(const Subject& subject);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_SCENE_H_
