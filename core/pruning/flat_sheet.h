#ifndef BCCSKEL_CORE_PRUNING_FLAT_SHEET_H_
#define BCCSKEL_CORE_PRUNING_FLAT_SHEET_H_

#include <optional>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/volume/volume.h"

namespace bccskel {

// Measures distances within a flat part of the object. Its lines follow the sheet where it bends:
// where a line leaves the object it continues where the object lies above or below. All lengths are
// in lattice units; `normal`, `way` and `side` are perpendicular and have length 1.
// Threads: one thread per instance.
class FlatSheet {
 public:
  // Needs: `object`, to which `radius` belongs, outlives this; `radius` searches.
  FlatSheet(const Volume& object, const ExactRadius& radius);

  // The shortest of 16 lines across the normal; at most `longest`.
  double WidthAt(const Coordinates& place, const Coordinates& normal, double longest);
  // The distance to the rim, within half a unit, times CoarsenessOf(); `longest` if the rim is
  // farther away.
  double WayToRim(Coordinates place, const Coordinates& way, const Coordinates& normal,
                  double longest);
  // The shortest of seven lines between `way`, `side` and the reverse of `way`: the distance to the
  // rim on that side, however the sheet tapers.
  double WayToSide(const Coordinates& place, const Coordinates& way, const Coordinates& side,
                   const Coordinates& normal, double longest);
  // Moves the place, or the sheet directly above or below it, to the middle of the sheet's
  // thickness. No value beyond the rim.
  std::optional<Coordinates> MiddleNear(const Coordinates& place, const Coordinates& normal);
  // The normal at `place`: `normal` from nearby, turned toward the nearest background unless that
  // is the rim.
  Coordinates NormalNear(const Coordinates& place, const Coordinates& normal);

 private:
  std::optional<Coordinates> InSheetNear(const Coordinates& place, const Coordinates& normal);
  bool InObject(const Coordinates& place) { return bricks_.Contains(PointNear(place, scale_)); }

  const AxisScale scale_;
  const double step_;  // of a way, lattice units
  NearbyBricks bricks_;
  ExactRadius radius_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_FLAT_SHEET_H_
