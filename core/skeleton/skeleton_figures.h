#ifndef BCCSKEL_CORE_SKELETON_SKELETON_FIGURES_H_
#define BCCSKEL_CORE_SKELETON_SKELETON_FIGURES_H_

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// Measurements of a branch, in world units.
struct EdgeFigures {
  double length = 0;  // of the curve through its points, smoothed
  double mean_radius = 0;
  double min_radius = 0;
  double max_radius = 0;
  // Length / straight distance between the ends; none for a closed curve.
  std::optional<double> tortuosity;
};
EdgeFigures FiguresOf(const SkeletonGraph& graph, const SkeletonEdge& edge);
// The same with the result of SmoothCurve() for the edge.
EdgeFigures FiguresOf(const SkeletonGraph& graph, const SkeletonEdge& edge,
                      std::span<const WorldPoint> curve);

// Totals of a connected component of the graph.
struct ComponentFigures {
  uint64_t nodes = 0;
  uint64_t edges = 0;
  uint64_t ends = 0;
  uint64_t junctions = 0;
  uint64_t loops = 0;  // including those of closed surfaces
  uint64_t cavities = 0;
  double length = 0;      // of all edges, world units
  double max_radius = 0;  // world units
};

struct GraphComponents {
  std::vector<uint32_t> of_node;          // by node: position in `figures`
  std::vector<ComponentFigures> figures;  // in the order of their first nodes
};
// After a stop request it returns early: `of_node` has its size, but the rest is incomplete.
GraphComponents ComponentsOf(const SkeletonGraph& graph, const std::stop_token& stop = {});

// The sum of all components.
ComponentFigures TotalOf(const GraphComponents& components);

// The smooth curve through the points of an edge, one position for each, in world units: the mean
// of the point and up to four on either side, the farthest two at half weight, each moved to the
// middle by its shift. A path on a lattice is a staircase, up to 24 % too long; this curve is not.
// Each position is within half the radius of its point, or within the point's cell, the truncated
// octahedron |x|, |y|, |z| <= 1 and |x| + |y| + |z| <= 1.5 around it in lattice units, so the curve
// stays inside the object. The first and last point do not move; a closed curve without junction is
// smooth all around.
std::vector<WorldPoint> SmoothCurve(const SkeletonGraph& graph, const SkeletonEdge& edge);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_SKELETON_FIGURES_H_
