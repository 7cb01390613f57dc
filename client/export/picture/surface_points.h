#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_SURFACE_POINTS_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_SURFACE_POINTS_H_

#include <vector>

#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel::exporting {

// The object points that lack a D6 neighbor, in brick order: what a picture of the object shows.
std::vector<LatticePoint> SurfacePoints(const Volume& object);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_SURFACE_POINTS_H_
