#ifndef BCCSKEL_TESTS_SUPPORT_RANDOM_OBJECTS_H_
#define BCCSKEL_TESTS_SUPPORT_RANDOM_OBJECTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

// Seeded objects for tests of laws. The same seed gives the same points on every machine. All
// coordinates are >= 0, so VolumeOfPoints() takes the result.

namespace bccskel::test {

// Each lattice point of a box of `extent` cells, with probability `density`.
std::vector<LatticePoint> RandomCloud(uint64_t seed, LatticeExtent extent, double density);

// The union of `balls` balls with radii 2..largest_radius (lattice units) and centers in a box of
// `extent` cells.
std::vector<LatticePoint> RandomBlob(uint64_t seed, LatticeExtent extent, int balls,
                                     double largest_radius);

// Flips about `fraction` of the border: object points with a background neighbor leave, background
// points with an object neighbor join, all chosen on the given object.
std::vector<LatticePoint> WithNoisyBoundary(uint64_t seed, std::span<const LatticePoint> points,
                                            double fraction);

// Each given point with probability `density`.
std::vector<LatticePoint> RandomSubset(uint64_t seed, std::span<const LatticePoint> points,
                                       double density);

// The points moved by a lattice vector.
std::vector<LatticePoint> Translated(std::span<const LatticePoint> points, LatticePoint by);

// Moves the object so that it crosses bricks in another place for each seed.
Volume PlacedVolume(uint64_t seed, std::span<const LatticePoint> points);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_RANDOM_OBJECTS_H_
