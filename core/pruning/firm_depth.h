#ifndef BCCSKEL_CORE_PRUNING_FIRM_DEPTH_H_
#define BCCSKEL_CORE_PRUNING_FIRM_DEPTH_H_

#include <array>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/pruning/point_table.h"
#include "core/volume/volume.h"

namespace bccskel {

// The distance of object points to the background without pits (FillPits()), where only few are
// asked for.
// Does:  looks for the nearest background point and, while that is a pit, takes it from the
//        background and looks again. There are few pits near tips: filling those of the whole
//        object, and finding out where the background of the result begins, took as long as 600
//        searches.
// Why it is right: what is found is no pit, so it stays background however many pits are filled.
//   Were q nearer and no pit either, the next point from q along an axis toward the point asked for
//   would be nearer still, so an object point or a pit: call it r. Then q lies in one of the boxes
//   of BorderBricks and would have been found. Beside object points that is what they are. Beside
//   a pit r, one of the four neighbors that q and r share is an object point; or at least eight of
//   the other nine neighbors of r but q are, so at least three of the four that lie across the way
//   to q. Two of those lie in other bricks than r at most, so one in r's brick, which is stored
//   then, and the box around that brick's points, with one cell more, reaches q.
// Threads: one thread per instance.
class FirmDepth {
 public:
  // Needs: `object`, to which `radius` belongs, outlives this.
  FirmDepth(const Volume& object, const ExactRadius& radius);

  // Lattice units. Needs: an object point.
  float At(LatticePoint p);
  // At(p) is no more. Not searched for: the distance to background found lately.
  float AtMost(LatticePoint p) const;

 private:
  float Search(LatticePoint p);
  bool IsPit(LatticePoint q);
  void Remember(LatticePoint background);

  NearbyBricks bricks_;
  ExactRadius radius_;  // in the object without the pits that were filled
  PointTable<float> known_;
  // Background without pits. A ridge has some all around, so that of the last search is not enough.
  std::array<LatticePoint, 8> lately_;
  size_t oldest_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_FIRM_DEPTH_H_
