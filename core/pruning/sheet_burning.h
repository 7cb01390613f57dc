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

// Rates each point of a surface skeleton by the erosion thickness of its sheet. README.md of this
// folder gives the reasons.
// Does:  burns the skeleton from its rims and ends inward, one point at a time as points become
//        simple. A fire that starts at q reaches p at the time D(q) + 0.8 |p - q|, D the radius.
//        The erosion thickness of p is that time minus D(p), in lattice units. Where the fire
//        arrives at D(p) or earlier, p starts a fire of its own. A point where sheets meet burns
//        when all but one of them have burned, with the fire that came last. The value of a point
//        is the largest erosion thickness among the points that its fire reached through it, along
//        paths without detours.
// Source: Yan, Sykes, Chambers, Letscher, Ju, "Erosion thickness on medial axes of 3D shapes"
//         (2016), with straight distances instead of those along the sheet, which the lattice
//         overstates.
class SheetBurning {
 public:
  // Needs: `points` outlives this. Points p with kept[p] != 0 do not burn.
  SheetBurning(const ThinPoints& points, const AxisScale& scale, std::span<const uint8_t> kept,
               StopPoll& poll);

  // The points that burned, in the order in which they burned.
  const std::vector<PointIndex>& burned() const { return burned_; }
  // The value of a point that burned, in lattice units.
  double WorthOf(PointIndex p) const { return fires_[p].worth; }

 private:
  struct Fire {
    PointIndex origin = 0;
    bool is_out = false;
    bool waits = false;  // the point is simple and waits for its turn
    double arrival = 0;  // of the first fire since the point last became simple
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
