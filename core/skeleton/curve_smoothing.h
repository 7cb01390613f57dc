#ifndef BCCSKEL_CORE_SKELETON_CURVE_SMOOTHING_H_
#define BCCSKEL_CORE_SKELETON_CURVE_SMOOTHING_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// Closed curves have no junction; their first and last point are the same.
enum class CurveShape : uint8_t { kOpen, kClosed };
CurveShape ShapeOf(const SkeletonGraph& graph, const SkeletonEdge& edge);

// For each place along a curve the mean of the values there and at up to four places on either
// side. The first and last value of an open curve stay.
std::vector<Coordinates> MeansAlong(std::span<const Coordinates> values, CurveShape shape);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CURVE_SMOOTHING_H_
