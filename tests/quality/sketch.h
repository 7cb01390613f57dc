#ifndef BCCSKEL_TESTS_QUALITY_SKETCH_H_
#define BCCSKEL_TESTS_QUALITY_SKETCH_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/import/shapes/solids.h"
#include "core/volume/volume.h"
#include "tests/quality/known_figure.h"
#include "tests/quality/voxel_mask.h"

// Solids as signed functions, the union of swept sections, for shapes that rows of spans cannot
// draw: flat limbs in any direction, flat cuts, rough surfaces.

namespace bccskel::quality {

using shapes::Vector;

// A section that is swept along an axis and tapers: the hull of two balls, pressed flat along
// `normal`. With `square` a block as long as the axis.
struct Piece {
  Vector from;
  Vector to;
  double from_radius = 1;  // half the width
  double to_radius = 1;
  double flat = 1;            // width by thickness
  Vector normal = {0, 0, 1};  // of length 1; perpendicular to the axis of flat pieces
  bool square = false;
  // Planes across the axis: nothing of the piece lies before the first or behind the second.
  std::optional<Vector> first_cut = std::nullopt;
  std::optional<Vector> last_cut = std::nullopt;
};
Piece Reversed(Piece piece);
// The same, cut through where its axis ends, or that far beyond.
Piece CutAtEnd(Piece piece, double beyond = 0);

// Where a center line ends: somewhere from the middle of the last ball to where the ridge of the
// distances ends.
struct Tip {
  Vector inner;
  Vector outer;
  double reach = 0;  // an end this far away may still belong to the tip
};

struct Sketch {
  std::vector<Piece> pieces = {};
  std::vector<Tip> tips = {};
  std::vector<Piece> line = {};  // the middle of limbs, with half their widths
  int junctions = -1;            // -1: not known
  int loops = -1;                // the same
  bool knows_ends = true;        // else nobody can say how many there should be
  double rough = 0;              // how far the surface goes in and out,
  double wavelength = 1;         // and in which distance

  // A piece that ends in a tip and sticks out that far.
  void AddLimb(const Piece& piece, double out);
  void AddTipOf(const Piece& piece, double out);
};
Sketch Turned(Sketch sketch, const Frame& frame);
// Moved to positive coordinates, `margin` and a bit that the seed decides from them.
Sketch Moved(Sketch sketch, double margin, uint64_t seed);

enum class Grid : uint8_t { kBcc, kCubic };

// Calls visit(x, y, z) for the points of a grid, those of the bcc lattice or all whole numbers,
// that lie inside. Needs: positive coordinates.
// Does: halves boxes until the function, which is no larger than the distance to the surface, says
//       that they are all in or all out.
void ForEachPoint(const Sketch& sketch, Grid grid,
                  const std::function<void(int32_t, int32_t, int32_t)>& visit);
uint64_t CountPoints(const Sketch& sketch, Grid grid);
// World coordinates are the sketch's.
absl::StatusOr<Volume> SampleOnBcc(const Sketch& sketch);
VoxelMask SampleOnVoxels(const Sketch& sketch);

double DistanceToSegment(Vector p, Vector a, Vector b);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_SKETCH_H_
