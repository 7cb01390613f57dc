#ifndef BCCSKEL_CORE_PRUNING_SHEET_BURNING_H_
#define BCCSKEL_CORE_PRUNING_SHEET_BURNING_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/distance/chamfer_weights.h"
#include "core/exec/stop_poll.h"
#include "core/pruning/sheet_set.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

// How much each point of a surface skeleton stands for, by the erosion thickness of its sheet.
// Does:  burns the skeleton from its rims and ends inward, points one by one as they become simple.
//        A fire starts at a point q when a ball that grows from nothing has its radius, D(q), and
//        comes to p when it has D(q) + 0.8 |p - q|. The erosion thickness of p is how much more
//        that is than D(p): how long the sheet is beside what its balls are wide. Where fires come
//        late, at or before D(p), the sheet behind them was the ball's own bump, and p starts a
//        fire of its own. A place where sheets meet burns when all but one of them have burned,
//        with the fire that came last. A point is worth the most of those that its fire reached
//        through it, along ways that are no detours.
// Why:   noise makes sheets from the rim to the surface's bumps, in which D falls by one a unit, or
//        between two pits a distance d apart, in which it falls by less than 0.8 only near the
//        pits: those are worth 0.2 d. The fin has burned when the fire of the sheet that it
//        stands on comes by, so it does not share in that sheet's worth; the bevels of a box burn
//        last before its middle and do.
// Source: Yan, Sykes, Chambers, Letscher, Ju, "Erosion thickness on medial axes of 3D shapes"
//         (2016), with straight distances for those along the sheet, which the lattice overstates.
class SheetBurning {
 public:
  // Both outlive this. Points p with kept[p] other than 0 do not burn.
  SheetBurning(const ThinPoints& points, const AxisScale& scale, std::span<const uint8_t> kept,
               StopPoll& poll);

  // Those that burned, the first first.
  const std::vector<PointIndex>& burned() const { return burned_; }
  // Of a point that burned; lattice units.
  double WorthOf(PointIndex p) const { return fires_[p].worth; }

 private:
  struct Fire {
    PointIndex origin = 0;
    bool is_out = false;
    bool waits = false;  // it is simple
    double arrival = 0;  // of the fire that comes first since the point last became simple
    double time = 0;     // when it burns
    double exposed = 0;  // when it became simple
    double worth = 0;
  };
  double ArrivalFrom(PointIndex origin, PointIndex p) const;
  void Burn(std::span<const uint8_t> kept, StopPoll& poll);
  void Rate();

  const ThinPoints& points_;
  const AxisScale scale_;
  SheetSet rest_;
  std::vector<Fire> fires_;
  std::vector<PointIndex> burned_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SHEET_BURNING_H_
