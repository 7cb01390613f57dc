#include "core/skeleton/skeleton_figures.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/distance/places.h"
#include "core/exec/union_find.h"
#include "core/skeleton/curve_smoothing.h"

namespace bccskel {
namespace {

double LengthOfCurve(std::span<const WorldPoint> curve) {
  double length = 0;
  for (size_t n = 1; n < curve.size(); ++n) length += DistanceBetween(curve[n - 1], curve[n]);
  return length;
}

// How much of a way from p, in lattice units, stays within half the radius of p or within its cell.
// The cells are the truncated octahedra around the points of the lattice, which fill space, so
// those of the object's points are the object. Thin limbs need them: some of their points lie on
// the surface, where radii say nothing of how far the middle may be.
double ShareInside(const SkeletonGraph& graph, const SkeletonPoint& p, const Coordinates& way) {
  double square = 0, farthest = 0, sum = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double units = std::abs(way[axis]), along = units * graph.placement.spacing[axis] / 2;
    square += along * along;
    farthest = std::max(farthest, units);
    sum += units;
  }
  const double to_ball = graph.RadiusOf(p) / 2 / std::sqrt(square);
  const double to_cell = std::min(1 / farthest, 1.5 / sum);
  return std::max(to_ball, to_cell);
}

void AddNode(const SkeletonGraph& graph, const SkeletonNode& node, ComponentFigures& figures) {
  ++figures.nodes;
  figures.ends += node.kind == NodeKind::kEnd ? 1 : 0;
  figures.junctions += node.kind == NodeKind::kJunction ? 1 : 0;
  figures.loops += node.loops;
  figures.cavities += node.cavities;
  figures.max_radius = std::max(figures.max_radius, graph.RadiusOf(node.at));
}

}  // namespace

std::vector<WorldPoint> SmoothCurve(const SkeletonGraph& graph, const SkeletonEdge& edge) {
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  std::vector<Coordinates> middles;
  middles.reserve(points.size());
  for (const SkeletonPoint& p : points) {
    Coordinates& middle = middles.emplace_back(PlaceOf(p.point, kIsotropic));
    for (size_t axis = 0; axis < 3; ++axis) {
      middle[axis] += p.shift[axis] / static_cast<double>(kShiftUnits);
    }
  }
  const std::vector<Coordinates> means = MeansAlong(middles, ShapeOf(graph, edge));
  std::vector<WorldPoint> curve;
  curve.reserve(points.size());
  for (size_t n = 0; n < points.size(); ++n) {
    const Coordinates from = PlaceOf(points[n].point, kIsotropic), way = Sum(means[n], -1, from);
    const double share = ShareInside(graph, points[n], way);
    const Coordinates at = share < 1 ? Sum(from, share, way) : means[n];
    curve.push_back(graph.placement.ToWorld(at[0], at[1], at[2]));
  }
  return curve;
}

EdgeFigures FiguresOf(const SkeletonGraph& graph, const SkeletonEdge& edge) {
  return FiguresOf(graph, edge, SmoothCurve(graph, edge));
}

EdgeFigures FiguresOf(const SkeletonGraph& graph, const SkeletonEdge& edge,
                      std::span<const WorldPoint> curve) {
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  EdgeFigures figures;
  if (points.empty()) return figures;
  figures.length = LengthOfCurve(curve);
  const auto [thinnest, thickest] = std::ranges::minmax_element(points, {}, &SkeletonPoint::radius);
  figures.min_radius = graph.RadiusOf(*thinnest);
  figures.max_radius = graph.RadiusOf(*thickest);
  for (const SkeletonPoint& p : points) figures.mean_radius += graph.RadiusOf(p);
  figures.mean_radius /= static_cast<double>(points.size());
  const double straight =
      DistanceBetween(graph.PositionOf(points.front()), graph.PositionOf(points.back()));
  if (straight > 0) figures.tortuosity = figures.length / straight;
  return figures;
}

GraphComponents ComponentsOf(const SkeletonGraph& graph, const std::stop_token& stop) {
  UnionFind<uint32_t> joined(graph.nodes.size());  // by their first node
  for (const SkeletonEdge& edge : graph.edges) joined.Unite(edge.source, edge.target);
  GraphComponents components;
  components.of_node.resize(graph.nodes.size());
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const uint32_t first = joined.Find(n);
    if (first == n) {
      components.of_node[n] = static_cast<uint32_t>(components.figures.size());
      components.figures.emplace_back();
    } else {
      components.of_node[n] = components.of_node[first];
    }
    AddNode(graph, graph.nodes[n], components.figures[components.of_node[n]]);
  }
  for (const SkeletonEdge& edge : graph.edges) {
    if (stop.stop_requested()) break;
    ComponentFigures& figures = components.figures[components.of_node[edge.source]];
    const EdgeFigures measured = FiguresOf(graph, edge);
    ++figures.edges;
    figures.length += measured.length;
    figures.max_radius = std::max(figures.max_radius, measured.max_radius);
  }
  for (ComponentFigures& figures : components.figures) {
    figures.loops += figures.edges + 1 - figures.nodes;
  }
  return components;
}

ComponentFigures TotalOf(const GraphComponents& components) {
  ComponentFigures total;
  for (const ComponentFigures& one : components.figures) {
    total.nodes += one.nodes;
    total.edges += one.edges;
    total.ends += one.ends;
    total.junctions += one.junctions;
    total.loops += one.loops;
    total.cavities += one.cavities;
    total.length += one.length;
    total.max_radius = std::max(total.max_radius, one.max_radius);
  }
  return total;
}

}  // namespace bccskel
