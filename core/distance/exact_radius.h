#ifndef BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
#define BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_

#include <array>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "core/distance/border_bricks.h"
#include "core/distance/distance_field.h"
#include "core/distance/nearest_background.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// The exact Euclidean distance of single points to the nearest background point, where only few are
// asked for. Taken from a Euclidean field; else searched for, brick by brick. Copies share what was
// found out about the object.
// Needs:   `object` and `field`, which belongs to it, outlive this. Of chamfer fields the kind is
//          enough: their values are not read.
// Threads: one thread per instance.
class ExactRadius {
 public:
  ExactRadius(const Volume& object, const DistanceField& field);

  // Lattice units; 0 for background points. The same bits however it is found.
  float At(LatticePoint p);

 private:
  ExactRadius(const Volume& object, const DistanceField& field, const AxisScale& scale);
  bool SearchWithin(float reach, LatticePoint p);
  float SquareOf(LatticePoint way, int32_t most) const;

  const Volume& object_;
  const DistanceField& field_;
  std::shared_ptr<const BorderBricks> border_;  // null where the field is Euclidean
  std::vector<NearBox> near_groups_;            // room for all
  std::array<float, 3> squares_;                // of a lattice coordinate along each axis
  SquaredWays<1> squared_y_;
  SquaredWays<kBrickY> squared_z_;
  NearestPoint last_ = {{-1, -1, -1},
                        0};  // of the point asked for before, which is mostly close by
};

// The radii of all points of `thin`, in the order of Volume::ForEachPoint().
// Needs:  the points of `thin` are points of `object`.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::vector<float>> ExactRadii(const Volume& thin, const Volume& object,
                                              const DistanceField& field,
                                              const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
