#ifndef BCCSKEL_CORE_PRUNING_FIRM_DEPTH_H_
#define BCCSKEL_CORE_PRUNING_FIRM_DEPTH_H_

#include <array>
#include <optional>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/pruning/point_table.h"
#include "core/volume/volume.h"

namespace bccskel {

// Computes the distance of a few object points to the background without pits, which are background
// points with at least eight object neighbors: those that Denoise() would add.
// Does:  finds the nearest background point. While that is a pit, removes it from the background
//        and searches again. Few pits lie near tips; filling those of the whole object and locating
//        the border of the resulting background took as long as 600 searches.
// Why it is right: the point found is not a pit, so it stays background however many pits are
//   filled. Suppose a point q that is not a pit were nearer. The next point r from q along an axis,
//   toward the query point, would be nearer still, so r is an object point or a pit. Then q lies in
//   one of the boxes of BorderBricks and would have been found: if r is an object point, those
//   boxes hold its neighbors. If r is a pit, either one of the four neighbors that q and r share is
//   an object point; or at least eight of the other nine neighbors of r except q are object points,
//   so at least three of the four that lie across the direction to q. At most two of those lie in
//   other bricks than r, so one lies in r's brick. That brick is then stored, and the box around
//   its points, grown by one cell, reaches q.
// Threads: one thread per instance.
class FirmDepth {
 public:
  // Needs: `object`, to which `radius` belongs, outlives this.
  FirmDepth(const Volume& object, const ExactRadius& radius);

  // Lattice units. Needs: p is an object point.
  float At(LatticePoint p);
  // An upper bound of At(p) without a search: the distance to background points found recently.
  float AtMost(LatticePoint p) const;

 private:
  struct Recent {
    LatticePoint at;
    float distance;
  };

  // The nearest to p of the background points found recently; at an infinite distance if there are
  // none.
  Recent NearestRecent(LatticePoint p) const;
  float Search(LatticePoint p);
  bool IsPit(LatticePoint q);
  void Remember(LatticePoint background);

  NearbyBricks bricks_;
  ExactRadius radius_;  // of the object with the pits found so far filled
  PointTable<float> known_;
  // Background points found recently that are not pits. A ridge has background all around it, so
  // the result of the last search alone is not enough.
  std::array<LatticePoint, 8> lately_;
  size_t oldest_ = 0;
};

// The distances by which tips are placed.
struct TipDepths {
  // Needs: `object`, to which `radius` belongs if it searches, outlives this.
  TipDepths(const Volume& object, const ExactRadius& radius)
      : searching(radius.searches() ? radius : ExactRadius(object)), firm(object, searching) {}

  ExactRadius searching;  // with pits
  FirmDepth firm;         // without
};

// The depths that one of several workers uses: worker 0 the given ones, the others their own.
class DepthsOfWorker {
 public:
  // Needs: as TipDepths().
  DepthsOfWorker(int worker, TipDepths& given, const Volume& object, const ExactRadius& radius)
      : given_(given) {
    if (worker > 0) own_.emplace(object, radius);
  }
  TipDepths& operator*() { return own_.has_value() ? *own_ : given_; }
  TipDepths* operator->() { return &**this; }

 private:
  TipDepths& given_;
  std::optional<TipDepths> own_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_FIRM_DEPTH_H_
