#ifndef BCCSKEL_TESTS_QUALITY_MEASURE_H_
#define BCCSKEL_TESTS_QUALITY_MEASURE_H_

#include <span>
#include <vector>

#include "core/import/shapes/solids.h"
#include "core/pipeline/skeletonize.h"
#include "tests/quality/known_figure.h"

// How far a skeleton is from the truth. Lattice units throughout.

namespace bccskel::quality {

using shapes::Vector;

// Of places against a center line.
struct Offsets {
  double mean = 0;
  double largest = 0;
  double bias = 0;  // length of the mean offset as a vector
};

struct TipMatch {
  int found = 0;
  int lost = 0;      // true tips without an end near by
  int spurious = 0;  // ends without a true tip near by
  double mean_gap = 0;
  double largest_gap = 0;
};

struct TipPair {
  double gap;
  size_t tip;
  size_t end;
};
// One to one, the nearest pair first.
TipMatch MatchNearest(std::vector<TipPair> pairs, size_t tips, size_t ends);

struct Judgment {
  Offsets raw;     // of the skeleton's points
  Offsets smooth;  // of the curves through them
  TipMatch tips;
  int ends = 0;
  int junctions = 0;
  double radius_bias = 0;    // mean of radius minus true radius, at the raw points
  double radius_error = 0;   // mean of its absolute value
  double length_error = 0;   // of the smoothed curves, relative
  double clustered = 0;      // share of the raw points that are in clusters
  uint64_t simple_left = 0;  // simple points that are no ends
};
Judgment Judge(const PlacedFigure& placed, const SkeletonizeResult& result);

// All edges' points, and the curves through them.
std::vector<Vector> RawPoints(const SkeletonGraph& graph);
std::vector<Vector> SmoothPoints(const SkeletonGraph& graph);
int CountNodes(const SkeletonGraph& graph, NodeKind kind);

// Between two sets of places: the mean way from a place to the nearest of the other set, of both
// sets together, and the largest one (Hausdorff). 0 if either is empty.
struct SetDistance {
  double mean = 0;
  double largest = 0;
};
SetDistance DistanceBetween(std::span<const Vector> a, std::span<const Vector> b);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_MEASURE_H_
