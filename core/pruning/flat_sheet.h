#ifndef BCCSKEL_CORE_PRUNING_FLAT_SHEET_H_
#define BCCSKEL_CORE_PRUNING_FLAT_SHEET_H_

#include <optional>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/volume/volume.h"

namespace bccskel {

// Ways in something flat. They follow it where it bends: where a way leaves the object it goes on
// where the object is above or below. All lengths are in lattice units; `normal`, `way` and `side`
// have length 1 and are perpendicular.
// Threads: one thread per instance.
class FlatSheet {
 public:
  // Needs: `object`, to which `radius` belongs, outlives this; `radius` searches.
  FlatSheet(const Volume& object, const ExactRadius& radius);

  // The shortest of 16 ways across the normal, `longest` at most.
  double WidthAt(const Coordinates& place, const Coordinates& normal, double longest);
  // To the rim, within half a unit; `longest` where it is farther.
  double WayToRim(Coordinates place, const Coordinates& way, const Coordinates& normal,
                  double longest);
  // The shortest of seven ways between `way`, `side` and the way back: the distance to the rim on
  // that side, however the sheet tapers.
  double WayToSide(const Coordinates& place, const Coordinates& way, const Coordinates& side,
                   const Coordinates& normal, double longest);
  // The place, or one above or below it, moved to the middle of the sheet's thickness; none beyond
  // the rim.
  std::optional<Coordinates> MiddleNear(const Coordinates& place, const Coordinates& normal);
  // The normal there, where it is known nearby: turned toward the nearest background, unless that
  // is the rim.
  Coordinates NormalNear(const Coordinates& place, const Coordinates& normal);

 private:
  std::optional<Coordinates> InSheetNear(const Coordinates& place, const Coordinates& normal);
  bool InObject(const Coordinates& place) { return bricks_.Contains(PointNear(place, scale_)); }

  const AxisScale scale_;
  NearbyBricks bricks_;
  ExactRadius radius_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_FLAT_SHEET_H_
