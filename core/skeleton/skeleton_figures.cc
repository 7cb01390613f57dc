#include "core/skeleton/skeleton_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/exec/disjoint_sets.h"
#include "core/skeleton/curve_smoothing.h"

namespace bccskel {
namespace {

double LengthOfCurve(std::span<const WorldPoint> curve) {
  double length = 0;
  for (size_t n = 1; n < curve.size(); ++n) length += DistanceBetween(curve[n - 1], curve[n]);
  return length;
}

// The place, or the one on the way to it that is as far from `from` as may be.
WorldPoint Within(double reach, const WorldPoint& from, const WorldPoint& place) {
  const double way = DistanceBetween(from, place);
  if (way <= reach) return place;
  WorldPoint nearer;
  for (size_t axis = 0; axis < 3; ++axis) {
    nearer[axis] = from[axis] + (place[axis] - from[axis]) * (reach / way);
  }
  return nearer;
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
  std::vector<WorldPoint> middles;
  for (const SkeletonPoint& p : graph.PointsOf(edge)) {
    middles.push_back(graph.ShiftedPositionOf(p));
  }
  std::vector<WorldPoint> curve = MeansAlong(middles, ShapeOf(graph, edge));
  for (size_t n = 0; n < curve.size(); ++n) {
    const SkeletonPoint& p = graph.PointsOf(edge)[n];
    curve[n] = Within(graph.RadiusOf(p) / 2, graph.PositionOf(p), curve[n]);
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

GraphComponents ComponentsOf(const SkeletonGraph& graph) {
  DisjointSets joined(graph.nodes.size());  // by their first node
  for (const SkeletonEdge& edge : graph.edges) joined.Join(edge.source, edge.target);
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

// Edges between the same nodes follow each other.
uint64_t CountNarrowLoops(const SkeletonGraph& graph, double width) {
  uint64_t narrow = 0;
  const auto same_nodes = [](const SkeletonEdge& a, const SkeletonEdge& b) {
    return a.source == b.source && a.target == b.target;
  };
  for (auto first = graph.edges.begin(); first != graph.edges.end();) {
    const auto last = std::find_if_not(
        first, graph.edges.end(), [&](const SkeletonEdge& e) { return same_nodes(*first, e); });
    const bool alone = first->source == first->target;
    if (alone || last - first > 1) {
      std::vector<EdgeFigures> sides;
      for (auto edge = first; edge != last; ++edge) sides.push_back(FiguresOf(graph, *edge));
      if (alone) sides.push_back({});  // each of these closes by itself
      std::ranges::sort(sides, {}, &EdgeFigures::length);
      for (size_t n = 1; n < sides.size(); ++n) {
        const double length = sides[0].length + sides[n].length;
        const double area =
            sides[0].length * sides[0].mean_radius + sides[n].length * sides[n].mean_radius;
        if (length / std::numbers::pi - 2 * area / length <= width) ++narrow;
      }
    }
    first = last;
  }
  return narrow;
}

}  // namespace bccskel
