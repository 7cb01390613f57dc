#ifndef BCCSKEL_CORE_PRUNING_TIP_STEPS_H_
#define BCCSKEL_CORE_PRUNING_TIP_STEPS_H_

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// A tip's merit is its depth plus this share of its distance along the limb. Toward a box's corner
// or the end of a round cap the depth falls by 1 per unit, toward the tip of a pointed limb by
// less.
inline constexpr double kTipSlope = 0.75;
inline constexpr double kTipPatience = 4;  // how far below the best a growing tip may fall

// Finds the points by which a limb grows at its tip.
// Needs:   `set`, `object` and `depth`, which belongs to the object, outlive this.
// Threads: one thread per instance.
class TipSteps {
 public:
  TipSteps(const ThinSet& set, const Volume& object, FirmDepth& depth)
      : set_(set), bricks_(object), depth_(depth) {}

  // The next object point: the one with the best score, the first on ties. The score adds the rise
  // of the depth and how straight ahead the point lies. The point's only neighbor in the set is the
  // tip, and it is farther from the anchor than the tip.
  // Needs: a path of at least one point that comes from the anchor, which is not part of it.
  std::optional<LatticePoint> Next(std::span<const LatticePoint> path, LatticePoint anchor);

 private:
  struct Step {
    LatticePoint to;
    size_t rank = 0;
    double length = 0;
    double straightness = 0;  // its part of the score
    double score_most = 0;    // upper bound of the score
  };

  void Find(std::span<const LatticePoint> path, LatticePoint anchor, double depth);
  bool IsFreeWay(LatticePoint tip, LatticePoint next, LatticePoint anchor);
  double Cosine(LatticePoint a, LatticePoint b, LatticePoint c) const;

  const ThinSet& set_;
  NearbyBricks bricks_;
  FirmDepth& depth_;
  std::vector<Step> steps_;  // from the tip, the most promising first
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TIP_STEPS_H_
