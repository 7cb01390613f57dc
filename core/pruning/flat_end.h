#ifndef BCCSKEL_CORE_PRUNING_FLAT_END_H_
#define BCCSKEL_CORE_PRUNING_FLAT_END_H_

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/flat_sheet.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Finds where the curve of a flat limb should end. In something flat the radius hardly changes up
// to the rim, so thinning leads the curve into one of the limb's corners. In the limb's own plane
// widths are what radii are in space: W, the distance to the rim within the sheet, is the same
// along the limb and falls toward a corner.
// Does:  walks along the middle of the sheet, where the rim is as far on either side, from where
//        the limb is as wide as anywhere, and one W before, to the rim. The end is the place with
//        the largest sum of W and 0.85 of the way, as for tips in space (tips.h). Where the rim
//        ahead is nearer than W, the walk goes straight on: there the middle leads into a corner
//        as well.
//        Where the limb cannot grow along this way, its end is the place of its path with the
//        largest sum of W and 0.75 of the way along the limb, less 0.4 of the way aside: the point
//        of a leaf lies ahead, a corner of a strip aside. The limb's direction is that of the way
//        to the last place that is as wide as any.
//        The removed part lies within 1.75 W and 6 units of an end, and the limb is at least
//        0.4 W long before it: corners of plates, which do not end limbs, stay. The normal of a
//        place is that to the nearest background.
// Threads: one thread per instance.
class FlatEnd {
 public:
  struct Place {
    size_t position = 0;
    double width = 0;
    bool flat = false;  // much wider than deep
  };
  struct Tip {
    size_t last = 0;                  // position in the path of the last point to keep, unless the
    size_t from = 0;                  // limb grows from here
    std::vector<Coordinates> middle;  // by these places
  };

  // Needs: `object`, to which `radius` and `depth` belong, and `depth` outlive this; `radius`
  //        searches.
  FlatEnd(const Volume& object, const ExactRadius& radius, FirmDepth& depth);

  // None where the limb is not flat.
  // Needs: a path of at least one point, from where the limb begins to its end, all in `set`.
  std::optional<Tip> In(std::span<const LatticePoint> path, const ThinSet& set);

 private:
  std::vector<Place> WidePlaces(std::span<const LatticePoint> path, const ThinSet& set);
  Coordinates WayToBackground(std::span<const LatticePoint> path, size_t position,
                              const ThinSet& set);
  Coordinates NormalAt(std::span<const LatticePoint> path, size_t position, const ThinSet& set);

  // One that walks along the middle of the limb.
  struct Walker {
    Coordinates place;
    Coordinates normal;  // of length 1
    Coordinates way;     // the same, across the normal
  };
  struct Sides {
    double width = 0;  // W
    double ahead = 0;  // to the rim
  };
  std::vector<Coordinates> MiddleFrom(Walker walker, double widest, double longest);
  bool Step(Walker& walker);
  Sides MoveToMiddle(Walker& walker, double widest);

  const AxisScale scale_;
  ExactRadius radius_;
  FlatSheet sheet_;
  FirmDepth& depth_;
  std::vector<std::optional<Coordinates>> ways_;  // to the background, where asked for
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_FLAT_END_H_
