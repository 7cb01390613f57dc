#include "client/export/polylines.h"

#include <span>

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

}  // namespace

Polylines PolylinesOf(const SkeletonGraph& graph) {
  Polylines result;
  result.lone_points = LoneNodes(graph);
  for (const SkeletonNode& node : graph.nodes) result.points.push_back(node.at);
  for (const SkeletonEdge& edge : graph.edges) {
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
