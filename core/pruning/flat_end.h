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

// Finds where the curve of a flat limb should end. In a flat part the radius hardly changes up to
// the rim, so thinning leads the curve into one of the limb's corners. W, the distance to the rim
// within the sheet, plays the role of the radius there. README.md of this folder gives the reasons.
// Does:  walks along the middle of the sheet from one W before the last place that is as wide as
//        any. The end is the place with the largest sum of W and 0.85 of the distance walked, minus
//        the distance from the straight continuation (WayOn in limb_anchor.h). Where the limb
//        cannot grow along this walk, its end is the place of its path with the largest W plus 0.75
//        of the distance along the limb minus 0.4 of the sideways distance. The removed part lies
//        within 1.75 W + 6 units of the end, and the limb before it is at least 0.3 W long.
// Threads: one thread per instance.
class FlatEnd {
 public:
  struct Place {
    size_t position = 0;
    double width = 0;
    bool flat = false;  // W is much larger than the radius
  };
  struct Tip {
    size_t last = 0;  // position in the path of the last point to keep if the limb cannot grow
    size_t from = 0;  // else: position in the path where growth starts
    std::vector<Coordinates> middle;  // the places along which the limb grows
  };

  // Needs: `object`, to which `radius` and `depth` belong, and `depth` outlive this; `radius`
  //        searches.
  FlatEnd(const Volume& object, const ExactRadius& radius, FirmDepth& depth);

  // No value if the limb is not flat. Needs: a path of at least one point, from where the limb
  // begins to its end, all in `set`.
  std::optional<Tip> In(std::span<const LatticePoint> path, const ThinSet& set);

 private:
  std::vector<Place> WidePlaces(std::span<const LatticePoint> path, const ThinSet& set);
  Coordinates WayToBackground(std::span<const LatticePoint> path, size_t position,
                              const ThinSet& set);
  Coordinates NormalAt(std::span<const LatticePoint> path, size_t position, const ThinSet& set);

  // A position of the walk along the middle of the limb.
  struct Walker {
    Coordinates place;
    Coordinates normal;  // of length 1
    Coordinates way;     // of length 1, perpendicular to the normal
  };
  struct Sides {
    double width = 0;  // W
    double ahead = 0;  // distance to the rim
  };
  // `straight`: the limb is straight for long enough to show its direction.
  std::vector<Coordinates> MiddleFrom(Walker walker, double widest, double longest, bool straight);
  size_t BestOf(std::span<const Coordinates> places, std::span<const double> widths,
                const std::optional<Coordinates>& way) const;
  bool Step(Walker& walker);
  Sides MoveToMiddle(Walker& walker, double widest);

  const AxisScale scale_;
  const double walk_step_;  // lattice units
  ExactRadius radius_;
  FlatSheet sheet_;
  FirmDepth& depth_;
  std::vector<std::optional<Coordinates>> ways_;  // cached directions to the background
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_FLAT_END_H_
