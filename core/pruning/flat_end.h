#ifndef BCCSKEL_CORE_PRUNING_FLAT_END_H_
#define BCCSKEL_CORE_PRUNING_FLAT_END_H_

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Finds where the curve of a flat limb should end. In something flat the radius hardly changes up
// to the rim, so thinning leads the curve into one of the limb's corners. In the limb's own plane
// widths are what radii are in space: W, the distance to the rim within the sheet, is the same
// along the limb and falls toward a corner.
// Does:  the end is the place with the largest sum of W and 0.75 of the way along the limb, as for
//        tips in space (tips.h), less 0.4 of the way aside: the point of a leaf lies ahead, a
//        corner of a strip aside. The limb's direction is that of the way to the last place that is
//        as wide as any. The removed part lies within 1.75 W and 6 units of the new end, and the
//        limb is at least W / 2 long before it: corners of plates, which do not end limbs, stay.
//        W is the shortest of 16 ways across the normal, which is that to the nearest background.
//        Such a way follows a bent sheet: where it leaves the object it goes on where the object is
//        above or below.
// Threads: one thread per instance.
class FlatEnd {
 public:
  struct Place {
    size_t position = 0;
    double width = 0;
    bool flat = false;  // much wider than deep
  };

  // Needs: `object`, to which `radius` and `depth` belong, and `depth` outlive this; `radius`
  //        searches.
  FlatEnd(const Volume& object, const ExactRadius& radius, FirmDepth& depth);

  // Position in the path of the last point to keep. None where the limb is not flat, or ends there.
  // Needs: a path of at least one point, from where the limb begins to its end, all in `set`.
  std::optional<size_t> In(std::span<const LatticePoint> path, const ThinSet& set);

 private:
  std::vector<Place> WidePlaces(std::span<const LatticePoint> path, const ThinSet& set);
  Coordinates WayToBackground(std::span<const LatticePoint> path, size_t position,
                              const ThinSet& set);
  Coordinates NormalAt(std::span<const LatticePoint> path, size_t position, const ThinSet& set);
  double WidthAt(const Coordinates& place, const Coordinates& normal, double longest);
  double WayToRim(Coordinates place, const Coordinates& way, const Coordinates& normal,
                  double longest);
  std::optional<Coordinates> InSheetNear(const Coordinates& place, const Coordinates& normal);
  bool InObject(const Coordinates& place) { return bricks_.Contains(PointNear(place, scale_)); }

  const AxisScale scale_;
  NearbyBricks bricks_;
  ExactRadius radius_;
  FirmDepth& depth_;
  std::vector<std::optional<Coordinates>> ways_;  // to the background, where asked for
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_FLAT_END_H_
