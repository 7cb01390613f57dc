#ifndef BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
#define BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
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

// Computes the exact Euclidean distance of single points to the nearest background point, for a few
// points: read from a Euclidean field, or searched for brick by brick. Copies share what was
// computed for the object.
// Needs:   `object` and `field`, which belongs to it, outlive this.
// Threads: one thread per instance.
class ExactRadius {
 public:
  // Always searches. The constructor visits all bricks, which takes as long as 50 to 200 searches.
  explicit ExactRadius(const Volume& object);
  // Searches unless the field is Euclidean; of other fields the values are not read.
  ExactRadius(const Volume& object, const DistanceField& field);

  bool searches() const { return field_ == nullptr; }

  // Lattice units; 0 for background points. The bits do not depend on how it is found.
  float At(LatticePoint p);
  // The square of At().
  float SquaredAt(LatticePoint p);
  // A background point at the distance that At() returned last; which one depends on the previous
  // queries.
  // Needs: this searches, and At() was called for an object point.
  LatticePoint nearest() const { return last_.at; }
  // Whether there is one: in a window all background may have been removed. At() is then larger
  // than the extent.
  bool has_nearest() const { return last_.at != kOutside.at; }
  // Of the background points nearest to p, the first by z, y and x.
  // Needs: this searches and nothing was removed from the background; p is an object point; radius
  //        <= At(p). If they are equal, only the few bricks at about that distance are visited.
  LatticePoint FirstNearestAt(LatticePoint p, float radius);
  // The distance from p to a background point, with the bits of At().
  float Between(LatticePoint p, LatticePoint background) const;

  // Begins the next search with the distance to this background point, which is likely to be near.
  void StartFrom(LatticePoint background) { last_.at = background; }
  // Removes q from the background of this copy. Background without object points beside it might
  // not be found either, so q must have enough of them around it (FirmDepth).
  // Needs: this searches.
  void TakeFromBackground(LatticePoint q);

 private:
  ExactRadius(const Volume& object, const DistanceField* field);
  std::span<const BrickBits> Bricks() const;
  std::span<const BorderBricks::Place> Places() const;
  static constexpr NearestPoint kOutside = {{-1, -1, -1}, 0};

  PointSearch SearchFrom(LatticePoint p, int32_t most);
  bool SearchWithin(float reach, LatticePoint p);
  void SearchAround(LatticePoint p);
  void FindBricksAround(LatticePoint p, float radius, bool is_exact);
  std::optional<LatticePoint> FirstAtDistance(LatticePoint p, float radius);
  size_t FindInBricksAround(LatticePoint p, float radius, bool is_exact);
  size_t FindInGroups(LatticePoint p, float radius);
  BrickIndex ChangedBrick(const BrickCoordinates& brick);
  float SquareTo(LatticePoint background, LatticePoint p, int32_t most) const;

  const Volume& object_;
  const DistanceField* field_;                  // null if this searches
  std::shared_ptr<const BorderBricks> border_;  // null if it does not
  // Empty if nothing was removed from the background. Bricks that are not stored follow the padding
  // brick.
  std::vector<BrickBits> changed_bricks_;
  std::vector<BorderBricks::Place> changed_places_;
  std::unordered_map<uint64_t, BrickIndex> added_bricks_;  // those that are not stored, by key
  std::vector<NearBox> near_groups_;                       // room for all
  NearbyBricks near_bricks_;
  AxisScale scale_;
  std::array<float, 3> squares_;  // of a lattice coordinate along each axis
  SquaredWays<1> squared_y_;
  SquaredWays<kBrickY> squared_z_;
  std::vector<BorderBricks::Place> bricks_around_;
  std::vector<NearestInPlace> found_;
  NearestPoint last_ = kOutside;  // of the previous query, which is usually close by
};

// The radii of all points of `thin`, in the order of Volume::ForEachPoint().
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::vector<float>> ExactRadii(const Volume& thin, const ExactRadius& radius,
                                              const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
