#include "client/export/graphml.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "client/export/node_kind_name.h"
#include "client/export/text.h"

namespace bccskel::exporting {
namespace {

constexpr std::string_view kHead =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<!-- curve skeleton by bccskel -->\n"
    "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\"\n"
    " xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\"\n"
    " xsi:schemaLocation=\"http://graphml.graphdrawing.org/xmlns "
    "http://graphml.graphdrawing.org/xmlns/1.0/graphml.xsd\">\n"
    "<key id=\"kind\" for=\"node\" attr.name=\"kind\" attr.type=\"string\"/>\n"
    "<key id=\"x\" for=\"node\" attr.name=\"x\" attr.type=\"double\"/>\n"
    "<key id=\"y\" for=\"node\" attr.name=\"y\" attr.type=\"double\"/>\n"
    "<key id=\"z\" for=\"node\" attr.name=\"z\" attr.type=\"double\"/>\n"
    "<key id=\"radius\" for=\"node\" attr.name=\"radius\" attr.type=\"double\"/>\n"
    "<key id=\"loops\" for=\"node\" attr.name=\"loops\" attr.type=\"int\"/>\n"
    "<key id=\"cavities\" for=\"node\" attr.name=\"cavities\" attr.type=\"int\"/>\n"
    "<key id=\"length\" for=\"edge\" attr.name=\"length\" attr.type=\"double\"/>\n"
    "<key id=\"mean_radius\" for=\"edge\" attr.name=\"mean_radius\" attr.type=\"double\"/>\n"
    "<key id=\"min_radius\" for=\"edge\" attr.name=\"min_radius\" attr.type=\"double\"/>\n"
    "<key id=\"points\" for=\"edge\" attr.name=\"points\" attr.type=\"string\"/>\n"
    "<graph id=\"skeleton\" edgedefault=\"undirected\">\n";

template <typename Value>
void AddData(Text& text, std::string_view key, const Value& value) {
  text.Add("<data key=\"", key, "\">", value, "</data>");
}

void AddNode(Text& text, const SkeletonGraph& graph, size_t n) {
  const SkeletonNode& node = graph.nodes[n];
  const WorldPoint p = graph.PositionOf(node.at);
  text.Add("<node id=\"n", n, "\">");
  AddData(text, "kind", NodeKindName(node.kind));
  AddData(text, "x", p[0]);
  AddData(text, "y", p[1]);
  AddData(text, "z", p[2]);
  AddData(text, "radius", graph.RadiusOf(node.at));
  if (node.kind == NodeKind::kClosedSurface) {
    AddData(text, "loops", node.loops);
    AddData(text, "cavities", node.cavities);
  }
  text.Add("</node>\n");
}

double MeanRadius(const SkeletonGraph& graph, std::span<const SkeletonPoint> points) {
  double sum = 0;
  for (const SkeletonPoint& p : points) sum += graph.RadiusOf(p);
  return points.empty() ? 0 : sum / static_cast<double>(points.size());
}

double MinRadius(const SkeletonGraph& graph, std::span<const SkeletonPoint> points) {
  const auto thinnest = std::ranges::min_element(points, {}, &SkeletonPoint::distance);
  return thinnest == points.end() ? 0 : graph.RadiusOf(*thinnest);
}

void AddPathPoints(Text& text, const SkeletonGraph& graph, std::span<const SkeletonPoint> points) {
  text.Add("<data key=\"points\">");
  std::string_view separator;
  for (const SkeletonPoint& point : points) {
    const WorldPoint p = graph.PositionOf(point);
    text.Add(separator, p[0], ' ', p[1], ' ', p[2], ' ', graph.RadiusOf(point));
    separator = "; ";
  }
  text.Add("</data>");
}

void AddEdge(Text& text, const SkeletonGraph& graph, size_t n) {
  const SkeletonEdge& edge = graph.edges[n];
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  text.Add("<edge id=\"e", n, "\" source=\"n", edge.source, "\" target=\"n", edge.target, "\">");
  AddData(text, "length", graph.LengthOf(edge));
  AddData(text, "mean_radius", MeanRadius(graph, points));
  AddData(text, "min_radius", MinRadius(graph, points));
  AddPathPoints(text, graph, points);
  text.Add("</edge>\n");
}

}  // namespace

std::string GraphMlText(const SkeletonGraph& graph) {
  Text text;
  text.Add(kHead);
  for (size_t n = 0; n < graph.nodes.size(); ++n) AddNode(text, graph, n);
  for (size_t n = 0; n < graph.edges.size(); ++n) AddEdge(text, graph, n);
  text.Add("</graph>\n</graphml>\n");
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
