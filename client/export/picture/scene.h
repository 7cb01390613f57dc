#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_SCENE_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_SCENE_H_

#include <vector>

#include "client/export/picture/display_curve.h"
#include "client/export/picture/projection.h"
#include "client/export/subject.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::exporting {

// What all views of a picture share.
struct Scene {
  std::vector<WorldPoint> surface;  // at least one point
  WorldBox box;                     // around the surface, half a step along z larger
  double point_spacing;             // world units between D8 neighbors, by the largest spacing
  std::vector<DisplayCurve> curves;
  RadiusRange radii;
};

Scene SceneOf(const Subject& subject);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_SCENE_H_
