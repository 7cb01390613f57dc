#include "client/export/polylines.h"

#include <span>

#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

std::span<const SkeletonPoint> InnerPoints(const SkeletonGraph& graph, const SkeletonEdge& edge) {
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  if (points.size() <= 2) return {};
  return points.subspan(1, points.size() - 2);
}

std::vector<size_t> LoneNodes(const SkeletonGraph& graph) {
  std::vector<char> touched(graph.nodes.size(), 0);
  for (const SkeletonEdge& edge : graph.edges) touched[edge.source] = touched[edge.target] = 1;
  std::vector<size_t> lone;
  for (size_t n = 0; n < touched.size(); ++n) {
    if (touched[n] == 0) lone.push_back(n);
  }
  return lone;
}

// In the order of Polylines::points.
std::vector<WorldPoint> SmoothPlaces(const SkeletonGraph& graph, const std::stop_token& stop) {
  std::vector<WorldPoint> places;
  for (const SkeletonNode& node : graph.nodes) places.push_back(graph.PositionOf(node.at));
  for (const SkeletonEdge& edge : graph.edges) {
    if (stop.stop_requested()) break;
    const std::vector<WorldPoint> curve = SmoothCurve(graph, edge);
    if (curve.empty()) continue;
    // The only kind of node that a smooth curve moves.
    if (graph.nodes[edge.source].kind == NodeKind::kLoop) places[edge.source] = curve.front();
    if (curve.size() > 2) places.insert(places.end(), curve.begin() + 1, curve.end() - 1);
  }
  for (const SkeletonPoint& p : graph.sheets) places.push_back(graph.PositionOf(p));
  return places;
}

}  // namespace

Polylines PolylinesOf(const SkeletonGraph& graph, const std::stop_token& stop) {
  Polylines result;
  result.places = SmoothPlaces(graph, stop);
  result.lone_points = LoneNodes(graph);
  for (const SkeletonNode& node : graph.nodes) result.points.push_back(node.at);
  for (const SkeletonEdge& edge : graph.edges) {
    if (stop.stop_requested()) break;
    std::vector<size_t> line = {edge.source};
    for (const SkeletonPoint& point : InnerPoints(graph, edge)) {
      line.push_back(result.points.size());
      result.points.push_back(point);
    }
    line.push_back(edge.target);
    result.lines.push_back(std::move(line));
  }
  result.first_of_sheets = result.points.size();
  for (const SkeletonPoint& point : graph.sheets) {
    result.lone_points.push_back(result.points.size());
    result.points.push_back(point);
  }
  return result;
}

}  // namespace bccskel::exporting
