#ifndef BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
#define BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// The exact Euclidean distance of single points to the nearest background point, where only few are
// asked for. Taken from a Euclidean field; else searched for, brick by brick, no farther than the
// chamfer distance says.
// Needs:   `object` and `field`, which belongs to it, outlive this.
// Threads: one thread per instance.
class ExactRadius {
 public:
  ExactRadius(const Volume& object, const DistanceField& field);

  // Lattice units; 0 for background points. The same bits however it is found.
  float At(LatticePoint p);

 private:
  // The bricks around one place in the lattice, of both sublattices; background ones are empty.
  struct Window {
    BrickCoordinates home;
    double reach = -1;                       // lattice units from any point of the home brick
    std::array<int32_t, 3> low = {0, 0, 0};  // in bricks
    std::array<int32_t, 3> size = {0, 0, 0};
    std::vector<BrickIndex> bricks;  // by z, y, x, sublattice

    size_t IndexOf(int32_t bx, int32_t by, int32_t bz) const {
      const auto at = [](int32_t v) { return static_cast<size_t>(v); };
      return 2 *
             ((at(bz - low[2]) * at(size[1]) + at(by - low[1])) * at(size[0]) + at(bx - low[0]));
    }
  };
  // The nearest background point so far.
  struct Nearest {
    LatticePoint at;
    float squared = 0;
  };

  float SquaredBetween(LatticePoint a, LatticePoint b) const;
  double UpperBound(BrickIndex brick, int bit) const;
  void OpenWindow(BrickCoordinates home, double reach);
  void FillRow(int32_t by, int32_t bz);
  void SearchWindow(LatticePoint p, Nearest& nearest) const;
  void SearchBrick(LatticePoint p, const BrickBits& bits, BrickCoordinates brick,
                   Nearest& nearest) const;
  float SquaredGap(LatticePoint p, int axis, int32_t brick) const;

  const Volume& object_;
  const DistanceField& field_;
  const AxisScale scale_;
  const double chamfer_factor_;  // from chamfer distances to upper bounds of straight ones
  const float square_x_;
  Window window_;
  Nearest last_;  // of the point asked for before, which is mostly close by
};

// The radii of all points of `thin`, in the order of Volume::ForEachPoint().
// Needs:  the points of `thin` are points of `object`.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<std::vector<float>> ExactRadii(const Volume& thin, const Volume& object,
                                              const DistanceField& field,
                                              const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
