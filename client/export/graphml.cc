#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/export/graph_formats.h"
#include "client/export/picture/escape.h"
#include "client/export/shared_text.h"
#include "client/export/text.h"
#include "core/skeleton/node_kind_name.h"
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
    "<key id=\"label\" for=\"all\" attr.name=\"label\" attr.type=\"string\"/>\n"
    "<key id=\"loops\" for=\"node\" attr.name=\"loops\" attr.type=\"int\"/>\n"
    "<key id=\"cavities\" for=\"node\" attr.name=\"cavities\" attr.type=\"int\"/>\n"
    "<key id=\"length\" for=\"edge\" attr.name=\"length\" attr.type=\"double\"/>\n"
    "<key id=\"mean_radius\" for=\"edge\" attr.name=\"mean_radius\" attr.type=\"double\"/>\n"
    "<key id=\"min_radius\" for=\"edge\" attr.name=\"min_radius\" attr.type=\"double\"/>\n"
    "<key id=\"max_radius\" for=\"edge\" attr.name=\"max_radius\" attr.type=\"double\"/>\n"
    "<key id=\"tortuosity\" for=\"edge\" attr.name=\"tortuosity\" attr.type=\"double\"/>\n"
    "<key id=\"pruning_level\" for=\"edge\" attr.name=\"pruning_level\" attr.type=\"double\"/>\n"
    "<key id=\"points\" for=\"edge\" attr.name=\"points\" attr.type=\"string\"/>\n";
constexpr std::string_view kBirthKeys =
    "<key id=\"birth\" for=\"node\" attr.name=\"birth\" attr.type=\"int\"/>\n"
    "<key id=\"births\" for=\"edge\" attr.name=\"births\" attr.type=\"string\"/>\n";
constexpr std::string_view kOrderKeys =
    "<key id=\"root\" for=\"node\" attr.name=\"root\" attr.type=\"string\"/>\n"
    "<key id=\"parent\" for=\"node\" attr.name=\"parent\" attr.type=\"string\"/>\n"
    "<key id=\"root_distance\" for=\"node\" attr.name=\"root_distance\" attr.type=\"double\"/>\n"
    "<key id=\"proximal\" for=\"edge\" attr.name=\"proximal\" attr.type=\"string\"/>\n"
    "<key id=\"generation\" for=\"edge\" attr.name=\"generation\" attr.type=\"int\"/>\n"
    "<key id=\"strahler\" for=\"edge\" attr.name=\"strahler\" attr.type=\"int\"/>\n"
    "<key id=\"closes_loop\" for=\"edge\" attr.name=\"closes_loop\" attr.type=\"boolean\"/>\n";

template <typename Value>
void AddData(Text& text, std::string_view key, const Value& value) {
  text.Add("<data key=\"", key, "\">", value, "</data>");
}

// Adds the label of row n, unless the graph is of one object.
void AddLabel(Text& text, const std::vector<uint64_t>& labels, size_t n) {
  if (!labels.empty()) AddData(text, "label", labels[n]);
}

// The keys that the context needs, and the graph's own data. The graph's keys have their own
// identifiers, because an option may have the name of a node's data: `cavities`.
void AddContext(Text& text, const GraphContext& context) {
  if (context.order.has_value()) text.Add(kOrderKeys);
  for (const auto& [name, value] : context.facts) {
    const std::string escaped = EscapeMarkup(name);
    text.Add("<key id=\"graph_", escaped, "\" for=\"graph\" attr.name=\"", escaped,
             "\" attr.type=\"string\"/>\n");
  }
  text.Add("<graph id=\"skeleton\" edgedefault=\"undirected\">\n");
  for (const auto& [name, value] : context.facts) {
    AddData(text, "graph_" + EscapeMarkup(name), EscapeMarkup(value));
  }
  if (!context.facts.empty()) text.Add('\n');
}

void AddNodeName(Text& text, std::string_view key, uint32_t node) {
  text.Add("<data key=\"", key, "\">n", node, "</data>");
}

void AddNodeOrderData(Text& text, const NodeOrder& order) {
  AddNodeName(text, "root", order.root);
  if (order.parent != kNoRow) AddNodeName(text, "parent", order.parent);
  AddData(text, "root_distance", order.root_distance);
}

void AddEdgeOrderData(Text& text, const EdgeOrder& order) {
  if (order.ClosesLoop()) return AddData(text, "closes_loop", "true");
  AddNodeName(text, "proximal", order.proximal);
  AddData(text, "generation", order.generation);
  AddData(text, "strahler", order.strahler);
}

void AddNode(Text& text, const SkeletonGraph& graph, size_t n, uint32_t component,
             const GraphContext& context) {
  const SkeletonNode& node = graph.nodes[n];
  const WorldPoint p = graph.PositionOf(node.at);
  text.Add("<node id=\"n", n, "\">");
  AddData(text, "kind", NodeKindName(node.kind));
  AddData(text, "x", p[0]);
  AddData(text, "y", p[1]);
  AddData(text, "z", p[2]);
  AddData(text, "radius", graph.RadiusOf(node.at));
  AddData(text, "component", component);
  if (node.at.birth > 0) AddData(text, "birth", node.at.birth);
  AddLabel(text, context.labels.of_nodes, n);
  if (context.order.has_value()) AddNodeOrderData(text, context.order->nodes[n]);
  if (node.kind == NodeKind::kClosedSurface || node.loops > 0) AddData(text, "loops", node.loops);
  if (node.kind == NodeKind::kClosedSurface) AddData(text, "cavities", node.cavities);
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

void AddBirths(Text& text, std::span<const SkeletonPoint> points) {
  text.Add("<data key=\"births\">");
  std::string_view separator;
  for (const SkeletonPoint& point : points) {
    text.Add(separator, point.birth);
    separator = " ";
  }
  text.Add("</data>");
}

void AddEdge(Text& text, const SkeletonGraph& graph, size_t n, const GraphContext& context,
             bool has_births) {
  const SkeletonEdge& edge = graph.edges[n];
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  text.Add("<edge id=\"e", n, "\" source=\"n", edge.source, "\" target=\"n", edge.target, "\">");
  const EdgeFigures figures = FiguresOf(graph, edge);
  AddLabel(text, context.labels.of_edges, n);
  if (context.order.has_value()) AddEdgeOrderData(text, context.order->edges[n]);
  AddData(text, "length", figures.length);
  AddData(text, "mean_radius", figures.mean_radius);
  AddData(text, "min_radius", figures.min_radius);
  AddData(text, "max_radius", figures.max_radius);
  if (figures.tortuosity.has_value()) AddData(text, "tortuosity", *figures.tortuosity);
  if (std::isfinite(edge.pruning_level)) AddData(text, "pruning_level", edge.pruning_level);
  AddPathPoints(text, graph, points);
  if (has_births) AddBirths(text, points);
  text.Add("</edge>\n");
}

}  // namespace

std::string GraphMlText(const SkeletonGraph& graph, const GraphContext& context) {
  Text text(context.exec.stop);
  text.Add(kHead);
  const bool has_births = graph.HasBirths();
  if (has_births) text.Add(kBirthKeys);
  AddContext(text, context);
  const GraphComponents components = ComponentsOf(graph, context.exec.stop);
  AddShared(text, graph.nodes.size(), context.exec, [&] {
    return [&](Text& piece, size_t n) { AddNode(piece, graph, n, components.of_node[n], context); };
  });
  AddShared(text, graph.edges.size(), context.exec, [&] {
    return [&](Text& piece, size_t n) { AddEdge(piece, graph, n, context, has_births); };
  });
  text.Add("</graph>\n</graphml>\n");
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
