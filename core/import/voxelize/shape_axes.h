#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_SHAPE_AXES_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_SHAPE_AXES_H_

#include <array>
#include <vector>

#include "core/import/mesh/mesh_report.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {

// A right-handed coordinate system of a surface's own.
struct ShapeAxes {
  WorldPoint origin;               // in the world
  std::array<WorldPoint, 3> axes;  // unit vectors

  // The surface in these coordinates, ready to be filled. Its report is unchanged.
  Surface Along(const Surface& surface) const;
  // Expresses a placement in these coordinates in the world.
  Placement ToWorld(const Placement& own) const;
};

// Axes that turn with a closed surface, so that the lattice meets it in the same way in every pose:
// the best first, then others at which it may resolve parts that it does not at these. None if the
// best are, or may as well be, the world's. Open surfaces have none: rounding would change where
// they enclose something.
// Does:  takes the normals of the two largest groups of parallel faces that are perpendicular to
//        each other, if they have a tenth and a twentieth of the area, as machine parts do; else
//        axes at fixed angles to the principal axes of the surface, by area. Puts the axis along
//        which the surface extends farthest first and lets two axes point to the side toward which
//        the surface is skewed. What symmetry leaves open is chosen to be close to the world's
//        axes.
std::vector<ShapeAxes> ShapeAxesOf(const Surface& surface);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_SHAPE_AXES_H_
