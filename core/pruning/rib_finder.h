#ifndef BCCSKEL_CORE_PRUNING_RIB_FINDER_H_
#define BCCSKEL_CORE_PRUNING_RIB_FINDER_H_

#include "core/distance/places.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/point_table.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Tells ribs: branches of a flat limb, one much wider than thick, that run from its middle to its
// rim, where every roughness makes one. Radii know how thick the limb is, not how wide, so by them
// a rib looks like a limb that leaves a body.
// Does:  looks along rays, across the branch, from places of its outer half. It is a rib where the
//        object goes on to both sides for 3/4 of the branch's length on average, and for 2.5 radii:
//        there it is wider than long, and flat. A finger is longer than wide, and so is the curve
//        of the flat limb itself.
// Cost:  about 30 rays for a branch that is none, which leave a round limb after a step or two.
// Threads: one thread per instance.
class RibFinder {
 public:
  // Needs: `object` outlives this.
  explicit RibFinder(const Volume& object);

  // Needs: the branch is one of `set`, whose points are points of the object, and has a junction;
  //        radii are always the same.
  bool IsRib(const ThinSet& set, const FreeBranch& branch);

 private:
  // What was found of a branch, which is asked for again whenever something near it goes.
  struct Verdict {
    LatticePoint junction;
    size_t points = 0;
    bool is_rib = false;
  };

  bool Look(const ThinSet& set, const FreeBranch& branch);
  Coordinates WayAt(const FreeBranch& branch, size_t n) const;
  bool IsWideAcross(const Coordinates& way, LatticePoint p, double radius, double length);
  double WayOut(const Coordinates& from, const Coordinates& way, double start, double reach);
  bool InObject(const Coordinates& place);

  const AxisScale scale_;
  NearbyBricks bricks_;
  PointTable<Verdict> verdicts_;  // by the branch's end
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_RIB_FINDER_H_
