#ifndef BCCSKEL_CLIENT_EXPORT_SAMPLED_CURVE_H_
#define BCCSKEL_CLIENT_EXPORT_SAMPLED_CURVE_H_

#include <optional>
#include <span>
#include <vector>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

struct CurveSampling {
  // The distance between points along the smooth curve in world units, rounded so that it divides
  // each edge. 0: the unsmoothed lattice points. None: twice the smallest spacing, which hides the
  // last ripples of the lattice, and at least an eighth of the largest.
  std::optional<double> step = std::nullopt;
};

// World coordinates and units.
struct CurvePoint {
  WorldPoint at;
  double radius;
};

// An edge from its source to its target.
// Needs: the step is not negative.
std::vector<CurvePoint> SampledCurve(const SkeletonGraph& graph, const SkeletonEdge& edge,
                                     const CurveSampling& sampling = {});

// The same with the default step, for a given SmoothCurve() of the edge.
std::vector<CurvePoint> SampledCurve(const SkeletonGraph& graph, const SkeletonEdge& edge,
                                     std::span<const WorldPoint> smooth);

// The length along the curve up to each of its points; 0 for an empty curve.
std::vector<double> WaysAlong(const std::vector<CurvePoint>& curve);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SAMPLED_CURVE_H_
