#ifndef BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
#define BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/distance/border_bricks.h"
#include "core/distance/chamfer_weights.h"
#include "core/distance/distance_field.h"
#include "core/distance/nearest_background.h"
#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// The exact Euclidean distance of single points to the nearest background point, where only few are
// asked for. Taken from a Euclidean field; else searched for, brick by brick. Copies share what was
// found out about the object.
// Needs:   `object` and `field`, which belongs to it, outlive this.
// Threads: one thread per instance.
class ExactRadius {
 public:
  // One that searches. Looking at all bricks first takes as long as 50 to 200 searches.
  explicit ExactRadius(const Volume& object);
  // Searches unless the field is Euclidean; of others the kind is enough, their values are not
  // read.
  ExactRadius(const Volume& object, const DistanceField& field);

  bool searches() const { return field_ == nullptr; }

  // Lattice units; 0 for background points. The same bits however it is found.
  float At(LatticePoint p);
  // Its square, which At() takes the root of.
  float SquaredAt(LatticePoint p);
  // A background point as far away as At() said last; which, depends on the points asked for
  // before. Needs: this searches, and At() was asked for an object point.
  LatticePoint nearest() const { return last_.at; }
  // Whether there is one: in a window all may be taken. Then At() says more than the extent is
  // long.
  bool has_nearest() const { return last_.at != kOutside.at; }
  // Of the background points that are nearest to p, the first by z, y and x.
  // Needs: this searches and nothing was taken; an object point; `radius`, At(p) or less. If it is
  //        At(p), only the few bricks that are about as far away are looked into.
  LatticePoint FirstNearestAt(LatticePoint p, float radius);
  // From p to a background point, with the bits of At().
  float Between(LatticePoint p, LatticePoint background) const;

  // From now on this copy does not find q. Background that has no object point beside it might not
  // be found either, so q must have enough of them around: see FirmDepth.
  // Needs: this searches.
  void TakeFromBackground(LatticePoint q);

 private:
  ExactRadius(const Volume& object, const DistanceField* field);
  std::span<const BrickBits> Bricks() const;
  std::span<const BorderBricks::Place> Places() const;
  static constexpr NearestPoint kOutside = {{-1, -1, -1}, 0};

  PointSearch SearchFrom(LatticePoint p, int32_t most);
  bool SearchWithin(float reach, LatticePoint p);
  void FindBricksAround(LatticePoint p, float radius);
  std::optional<LatticePoint> FirstAtDistance(LatticePoint p, float radius);
  size_t FindInBricksAround(LatticePoint p, float radius);
  size_t FindInGroups(LatticePoint p, float radius);
  BrickIndex ChangedBrick(const BrickCoordinates& brick);
  float SquareTo(LatticePoint background, LatticePoint p, int32_t most) const;

  const Volume& object_;
  const DistanceField* field_;                  // null where background is searched for
  std::shared_ptr<const BorderBricks> border_;  // null where it is not
  // Empty where nothing was taken. Behind the padding brick come those that are not stored.
  std::vector<BrickBits> changed_bricks_;
  std::vector<BorderBricks::Place> changed_places_;
  std::vector<NearBox> near_groups_;  // room for all
  NearbyBricks near_bricks_;
  AxisScale scale_;
  std::array<float, 3> squares_;  // of a lattice coordinate along each axis
  SquaredWays<1> squared_y_;
  SquaredWays<kBrickY> squared_z_;
  std::vector<BorderBricks::Place> bricks_around_;
  std::vector<NearestInPlace> found_;
  NearestPoint last_ = kOutside;  // of the point asked for before, which is mostly close by
};

// The radii of all points of `thin`, in the order of Volume::ForEachPoint().
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::vector<float>> ExactRadii(const Volume& thin, const ExactRadius& radius,
                                              const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
