#ifndef BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_
#define BCCSKEL_CORE_DISTANCE_EXACT_RADIUS_H_

#include <array>
#include <vector>

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// The exact Euclidean distance of single points to the nearest background point, where only few are
// asked for. Taken from a Euclidean field; else searched for, brick by brick.
// Needs:   `object` and `field`, which belongs to it, outlive this. Of chamfer fields the kind is
//          enough: their values are not read.
// Threads: one thread per instance.
class ExactRadius {
 public:
  ExactRadius(const Volume& object, const DistanceField& field);

  // Lattice units; 0 for background points. The same bits however it is found.
  float At(LatticePoint p);

 private:
  // A brick with background; along each axis its place in the window, times two for sublattices.
  struct WindowBrick {
    BrickIndex index = 0;
    std::array<uint32_t, 3> at = {0, 0, 0};
  };
  // The bricks with background around one place in the lattice.
  struct Window {
    BrickCoordinates home;
    double reach = -1;                       // lattice units from any point of the home brick
    std::array<int32_t, 3> low = {0, 0, 0};  // in bricks
    std::array<int32_t, 3> size = {0, 0, 0};
    std::vector<WindowBrick> bricks;
  };
  // Squares of the distances from a point, along y or z, to the rows of a brick.
  using SquaredRows = std::array<float, 4 * kBrickZ>;
  // The nearest background point so far.
  struct Nearest {
    LatticePoint at;
    float squared = 0;
  };

  float SquaredBetween(LatticePoint a, LatticePoint b) const;
  void OpenWindow(BrickCoordinates home, double reach);
  void FindWindowRow(int32_t by, int32_t bz);
  void AddWindowRow(int32_t y, int32_t z);
  int32_t LowAt(size_t axis, size_t n) const;
  void MeasureAxes(LatticePoint p);
  void MeasureGaps(size_t axis, int32_t from);
  void SearchWindow(LatticePoint p, Nearest& nearest);
  void SearchBrick(LatticePoint p, const WindowBrick& brick, Nearest& nearest) const;

  const Volume& object_;
  const DistanceField& field_;
  const AxisScale scale_;
  const float square_x_;
  Window window_;
  std::vector<BrickIndex> row_;  // of the window
  // Of the point asked for, by place in the window and sublattice.
  std::array<std::vector<SquaredRows>, 2> rows_;  // along y and z
  std::array<std::vector<float>, 3> gaps_;        // squares of the least distances
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
