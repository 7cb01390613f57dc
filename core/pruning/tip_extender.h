#ifndef BCCSKEL_CORE_PRUNING_TIP_EXTENDER_H_
#define BCCSKEL_CORE_PRUNING_TIP_EXTENDER_H_

#include <optional>
#include <span>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// A branch and its extension beyond the end. Shapes: as many radii as points.
struct BranchPath {
  std::vector<LatticePoint> points;  // the junction first
  std::vector<float> radii;          // lattice units
};

// Follows a limb beyond the end that thinning gave its branch. Thinning ends branches a few lattice
// units before the tips of their limbs; how many depends on pose and sampling. For limbs a few
// points thick that is a large part of how far they stick out.
// Does:  continues by object points in the direction of the last ten points, each time to the one
//        toward which the radius falls least, by at most kLongest. Adds nothing to the set.
// Threads: one thread per instance.
class TipExtender {
 public:
  static constexpr double kLongest = 3;        // lattice units
  static constexpr double kLargestRise = 0.5;  // of the radius: beyond, another limb begins

  // Needs: `radius` belongs to `object`, which outlives this. `surface_step`: that of the object's
  //        surface, lattice units; above 1 it is longer than the part of a limb that thinning
  //        omits.
  TipExtender(const Volume& object, const ExactRadius& radius, double surface_step = 1);

  // Adds nothing if a step of the surface is longer than 1. Needs: a path of at least two points.
  void Append(BranchPath& path);
  // Continues straight on over the sheet in which the path ends, as long as the radius hardly
  // falls. Where a limb that is deeper than wide is cut square, such as the tooth of a gear,
  // thinning ends the curve half the depth before its rim or leads it into a corner, depending on
  // the pose. Adds nothing to round limbs, to ribs of sheets, which leave nothing thicker, and to
  // sheets as thin as rows of bumps. Needs: as Append().
  void AppendOverSheet(BranchPath& path);

 private:
  struct Step {
    LatticePoint to;
    float radius = 0;
    double score = 0;
  };

  AxisScale scale_;
  double surface_step_;
  NearbyBricks bricks_;
  ExactRadius radius_;
};

// The direction of the path around its point n, of length 1.
Coordinates DirectionAt(std::span<const LatticePoint> path, size_t n, const AxisScale& scale);

// Extends the path by a point twice the last radius beyond its end where the border of an image
// cuts the limb off: the path leads to the border, and the ball at its end reaches the border. (A
// limb that ends before the border has a ball that does, too.) Ignores single points. Returns
// whether it extended the path.
bool ExtendAcrossBorder(const std::optional<LatticeBox>& image, const AxisScale& scale,
                        BranchPath& path);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TIP_EXTENDER_H_
