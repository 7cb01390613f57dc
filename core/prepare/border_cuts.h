#ifndef BCCSKEL_CORE_PREPARE_BORDER_CUTS_H_
#define BCCSKEL_CORE_PREPARE_BORDER_CUTS_H_

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/distance/distance_field.h"
#include "core/lattice/lattice_point.h"
#include "core/lattice/lattice_point_hash.h"
#include "core/volume/volume.h"

namespace bccskel {

// Where the border of an image cuts limbs off.
struct BorderCuts {
  LatticeBox window = {};
  AxisScale scale = {1, 1, 1};
  std::vector<LatticePoint> middles;  // one of each cut, the deepest first
  std::unordered_map<LatticePoint, size_t, LatticePointHash> points;  // and their cuts

  // The middle of the cut to which a curve with another end leads: the face is within `reach`,
  // lattice units, straight on.
  std::optional<LatticePoint> MiddleBeside(LatticePoint end, double reach) const;
};

// Finds the parts of the object on the faces of its window that cut a flat limb across. Such a part
// is wider than round, and a straight way from its middle, within 45 degrees of the inward normal,
// along which the distance hardly changes, is longer than the part is wide. So neither a limb that
// runs along a face has a cut nor a body that touches one. Round limbs need none: thinning leads
// their curves to the border.
// Needs: `space` is the object in its window, `distance` that of the object in `space`.
BorderCuts FindBorderCuts(const Volume& space, const Volume& object, const DistanceField& distance);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_BORDER_CUTS_H_
