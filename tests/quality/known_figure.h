#ifndef BCCSKEL_TESTS_QUALITY_KNOWN_FIGURE_H_
#define BCCSKEL_TESTS_QUALITY_KNOWN_FIGURE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/shapes/solids.h"
#include "core/volume/volume.h"

namespace bccskel::quality {

// A solid whose curve skeleton is known, in figure units.
struct KnownFigure {
  std::string name;
  std::vector<shapes::Solid> solids = {};
  // The center line in pieces, with the radius of the solid around it; empty where only the tips
  // are known.
  std::vector<shapes::RoundCone> line = {};
  std::vector<shapes::RoundCone> tips = {};  // `to` is where the center line ends, with its radius
  int forks = 0;
  int loops = 0;
  bool turns = true;  // rotated at random; figures that lie along the axes on purpose are not
  double scale = 0;   // lattice units per figure unit; 0: so that it has the wanted size
};

// All of them. Random ones are the same on every run.
std::vector<KnownFigure> KnownFigures();

// Three vectors of length 1, normal to each other.
struct Frame {
  shapes::Vector x = {1, 0, 0};
  shapes::Vector y = {0, 1, 0};
  shapes::Vector z = {0, 0, 1};

  shapes::Vector Turn(shapes::Vector v) const { return v.x * x + v.y * y + v.z * z; }
  shapes::Vector TurnBack(shapes::Vector v) const { return {Dot(v, x), Dot(v, y), Dot(v, z)}; }
};
// Any rotation is as likely as any other.
Frame RandomFrame(uint64_t seed);
// Needs: no torus and no shell among the solids.
KnownFigure Turned(const KnownFigure& figure, const Frame& frame);

// A figure on the lattice: a figure point v lies at scale * v + shift.
struct PlacedFigure {
  KnownFigure figure;
  Volume object;
  double scale = 1;
  shapes::Vector shift = {};

  shapes::Vector ToLattice(shapes::Vector v) const { return scale * v + shift; }
};
// With about `points` points, unless the figure has a scale of its own.
absl::StatusOr<PlacedFigure> Place(const KnownFigure& figure, uint64_t points);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_KNOWN_FIGURE_H_
