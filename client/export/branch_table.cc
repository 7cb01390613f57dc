#include <cmath>
#include <string_view>
#include <utility>

#include "absl/strings/str_replace.h"
#include "client/export/graph_formats.h"
#include "client/export/picture/escape.h"
#include "client/export/text.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

// The numbers are skan's.
enum class BranchType : int {
  kEndToEnd = 0,
  kJunctionToEnd = 1,
  kBetweenJunctions = 2,
  kClosed = 3
};

BranchType TypeOf(const SkeletonGraph& graph, const SkeletonEdge& edge) {
  const NodeKind source = graph.nodes[edge.source].kind, target = graph.nodes[edge.target].kind;
  if (source == NodeKind::kLoop) return BranchType::kClosed;
  const int ends = (source == NodeKind::kEnd ? 1 : 0) + (target == NodeKind::kEnd ? 1 : 0);
  if (ends == 0) return BranchType::kBetweenJunctions;
  return ends == 2 ? BranchType::kEndToEnd : BranchType::kJunctionToEnd;
}

void AddHeader(Text& text, const GraphContext& context) {
  if (!context.labels.of_edges.empty()) text.Add("label,");
  text.Add("skeleton_id,branch_id,node_id_src,node_id_dst,branch_type,branch_distance,",
           "euclidean_distance,tortuosity,mean_radius,min_radius,max_radius,",
           "coord_src_x,coord_src_y,coord_src_z,coord_dst_x,coord_dst_y,coord_dst_z,",
           "pruning_level");
  if (context.order.has_value()) text.Add(",generation,strahler");
  text.Add(",world,unit\n");
}

void AddOrder(Text& text, const EdgeOrder& order) {
  if (order.ClosesLoop()) {
    text.Add(",,");
  } else {
    text.Add(',', order.generation, ',', order.strahler);
  }
}

void AddRow(Text& text, const SkeletonGraph& graph, size_t n, uint32_t component) {
  const SkeletonEdge& edge = graph.edges[n];
  const EdgeFigures figures = FiguresOf(graph, edge);
  const WorldPoint source = graph.PositionOf(graph.nodes[edge.source].at);
  const WorldPoint target = graph.PositionOf(graph.nodes[edge.target].at);
  text.Add(component, ',', n, ',', edge.source, ',', edge.target, ',',
           static_cast<int>(TypeOf(graph, edge)), ',', figures.length, ',',
           DistanceBetween(source, target), ',');
  if (figures.tortuosity.has_value()) text.Add(*figures.tortuosity);
  text.Add(',', figures.mean_radius, ',', figures.min_radius, ',', figures.max_radius);
  for (const WorldPoint& place : {source, target}) {
    for (const double coordinate : place) text.Add(',', coordinate);
  }
  text.Add(',');
  if (std::isfinite(edge.pruning_level)) text.Add(edge.pruning_level);
}

// A cell that holds any text.
std::string Quoted(std::string_view text) {
  std::string line = OnOneLine(text);
  if (line.find_first_of(",\"") == std::string::npos) return line;
  return "\"" + absl::StrReplaceAll(line, {{"\"", "\"\""}}) + "\"";
}

}  // namespace

std::string BranchTableText(const SkeletonGraph& graph, const GraphContext& context) {
  Text text(context.exec.stop);
  AddHeader(text, context);
  const GraphComponents components = ComponentsOf(graph, context.exec.stop);
  const std::string world = "," + Quoted(OrUnknown(FactNamed(context.facts, "world"))) + "," +
                            Quoted(OrUnknown(FactNamed(context.facts, "unit"))) + "\n";
  for (size_t n = 0; n < graph.edges.size() && !text.stopped(); ++n) {
    if (!context.labels.of_edges.empty()) text.Add(context.labels.of_edges[n], ',');
    AddRow(text, graph, n, components.of_node[graph.edges[n].source]);
    if (context.order.has_value()) AddOrder(text, context.order->edges[n]);
    text.Add(world);
  }
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
