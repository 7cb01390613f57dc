#include "client/export/graphml.h"

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "client/export/node_kind_name.h"
#include "client/export/text.h"
#include "core/skeleton/skeleton_figures.h"

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
    "<key id=\"component\" for=\"node\" attr.name=\"component\" attr.type=\"int\"/>\n"
    "<key id=\"label\" for=\"all\" attr.name=\"label\" attr.type=\"long\"/>\n"
    "<key id=\"loops\" for=\"node\" attr.name=\"loops\" attr.type=\"int\"/>\n"
    "<key id=\"cavities\" for=\"node\" attr.name=\"cavities\" attr.type=\"int\"/>\n"
    "<key id=\"length\" for=\"edge\" attr.name=\"length\" attr.type=\"double\"/>\n"
    "<key id=\"mean_radius\" for=\"edge\" attr.name=\"mean_radius\" attr.type=\"double\"/>\n"
    "<key id=\"min_radius\" for=\"edge\" attr.name=\"min_radius\" attr.type=\"double\"/>\n"
    "<key id=\"max_radius\" for=\"edge\" attr.name=\"max_radius\" attr.type=\"double\"/>\n"
    "<key id=\"tortuosity\" for=\"edge\" attr.name=\"tortuosity\" attr.type=\"double\"/>\n"
    "<key id=\"points\" for=\"edge\" attr.name=\"points\" attr.type=\"string\"/>\n"
    "<graph id=\"skeleton\" edgedefault=\"undirected\">\n";

template <typename Value>
void AddData(Text& text, std::string_view key, const Value& value) {
  text.Add("<data key=\"", key, "\">", value, "</data>");
}

// The label of row n; nothing where the graph is of one object.
void AddLabel(Text& text, const std::vector<uint64_t>& labels, size_t n) {
  if (!labels.empty()) AddData(text, "label", labels[n]);
}

void AddNode(Text& text, const SkeletonGraph& graph, size_t n, uint32_t component,
             const GraphLabels& labels) {
  const SkeletonNode& node = graph.nodes[n];
  const WorldPoint p = graph.PositionOf(node.at);
  text.Add("<node id=\"n", n, "\">");
  AddData(text, "kind", NodeKindName(node.kind));
  AddData(text, "x", p[0]);
  AddData(text, "y", p[1]);
  AddData(text, "z", p[2]);
  AddData(text, "radius", graph.RadiusOf(node.at));
  AddData(text, "component", component);
  AddLabel(text, labels.of_nodes, n);
  if (node.kind == NodeKind::kClosedSurface) {
    AddData(text, "loops", node.loops);
    AddData(text, "cavities", node.cavities);
  }
  text.Add("</node>\n");
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

void AddEdge(Text& text, const SkeletonGraph& graph, size_t n, const GraphLabels& labels) {
  const SkeletonEdge& edge = graph.edges[n];
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  text.Add("<edge id=\"e", n, "\" source=\"n", edge.source, "\" target=\"n", edge.target, "\">");
  const EdgeFigures figures = FiguresOf(graph, edge);
  AddLabel(text, labels.of_edges, n);
  AddData(text, "length", figures.length);
  AddData(text, "mean_radius", figures.mean_radius);
  AddData(text, "min_radius", figures.min_radius);
  AddData(text, "max_radius", figures.max_radius);
  if (figures.tortuosity.has_value()) AddData(text, "tortuosity", *figures.tortuosity);
  AddPathPoints(text, graph, points);
  text.Add("</edge>\n");
}

}  // namespace

std::string GraphMlText(const SkeletonGraph& graph, const GraphLabels& labels) {
  Text text;
  text.Add(kHead);
  const GraphComponents components = ComponentsOf(graph);
  for (size_t n = 0; n < graph.nodes.size(); ++n) {
    AddNode(text, graph, n, components.of_node[n], labels);
  }
  for (size_t n = 0; n < graph.edges.size(); ++n) AddEdge(text, graph, n, labels);
  text.Add("</graph>\n</graphml>\n");
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
