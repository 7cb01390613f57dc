#include "client/export/json.h"

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "client/export/method_facts.h"
#include "client/export/picture/escape.h"
#include "client/export/shared_text.h"
#include "client/export/text.h"
#include "core/pipeline/notes.h"
#include "core/skeleton/node_kind_name.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

constexpr std::string_view kBetweenItems = ",\n";

// A JSON list; `write_item` writes each of `items`.
template <typename Items, typename WriteItem>
void AddList(Text& text, std::string_view separator, const Items& items, WriteItem write_item) {
  text.Add('[');
  std::string_view before;
  for (const auto& item : items) {
    if (text.stopped()) return;
    text.Add(before);
    write_item(item);
    before = separator;
  }
  text.Add(']');
}

void AddPosition(Text& text, const WorldPoint& p) {
  text.Add('[', p[0], ',', p[1], ',', p[2], ']');
}

void AddNodeOrder(Text& text, const NodeOrder& order) {
  text.Add(",\"root\":", order.root);
  if (order.parent != kNoRow) text.Add(",\"parent\":", order.parent);
  text.Add(",\"root_distance\":", order.root_distance);
}

void AddEdgeOrder(Text& text, const EdgeOrder& order) {
  if (order.ClosesLoop()) {
    text.Add(",\"closes_loop\":true");
  } else {
    text.Add(",\"proximal\":", order.proximal, ",\"generation\":", order.generation,
             ",\"strahler\":", order.strahler);
  }
}

void AddNode(Text& text, const SkeletonGraph& graph, size_t n, uint32_t component,
             const std::optional<TreeOrder>& order) {
  const SkeletonNode& node = graph.nodes[n];
  text.Add("{\"id\":", n, ",\"kind\":\"", NodeKindName(node.kind), "\",\"position\":");
  AddPosition(text, graph.PositionOf(node.at));
  text.Add(",\"radius\":", graph.RadiusOf(node.at), ",\"component\":", component);
  if (node.at.birth > 0) text.Add(",\"birth\":", node.at.birth);
  if (node.kind == NodeKind::kClosedSurface) text.Add(",\"cavities\":", node.cavities);
  if (node.kind == NodeKind::kClosedSurface || node.loops > 0) {
    text.Add(",\"loops\":", node.loops);
  }
  if (order.has_value()) {
    AddNodeOrder(text, order->nodes[n]);
  }
  text.Add('}');
}

// Caches the texts of radii: many points have the same, and formatting digits is slow.
class RadiusTexts {
 public:
  explicit RadiusTexts(const SkeletonGraph& graph) : graph_(graph) {}

  std::string_view Of(const SkeletonPoint& p) {
    constexpr int kBits = 9;
    static_assert(kKept == size_t{1} << kBits);
    Known& known = known_[std::bit_cast<uint32_t>(p.radius) * 0x9e3779b1u >> (32 - kBits)];
    if (known.text.empty() || known.radius != p.radius) {
      known = {p.radius, std::move(Text().Add(graph_.RadiusOf(p))).Take()};
    }
    return known.text;
  }

 private:
  static constexpr size_t kKept = 512;
  struct Known {
    float radius = 0;
    std::string text;
  };

  const SkeletonGraph& graph_;
  std::array<Known, kKept> known_;
};

// Data shared by all edges.
struct EdgeContext {
  const std::optional<TreeOrder>& order;
  bool has_births;
  bool has_shifts;
  JsonParts parts;
};

void AddPoints(Text& text, const SkeletonGraph& graph, const SkeletonEdge& edge,
               const std::vector<WorldPoint>& curve, const EdgeContext& context,
               RadiusTexts& radii) {
  const auto points = graph.PointsOf(edge);
  text.Add(",\"points\":");
  AddList(text, ",", points,
          [&](const SkeletonPoint& p) { AddPosition(text, graph.PositionOf(p)); });
  text.Add(",\"radii\":");
  AddList(text, ",", points, [&](const SkeletonPoint& p) { text.Add(radii.Of(p)); });
  if (context.has_births) {
    text.Add(",\"births\":");
    AddList(text, ",", points, [&](const SkeletonPoint& p) { text.Add(p.birth); });
  }
  if (context.has_shifts) {
    text.Add(",\"shifts\":");
    AddList(text, ",", points, [&](const SkeletonPoint& p) {
      text.Add('[', p.shift[0], ',', p.shift[1], ',', p.shift[2], ']');
    });
  }
  text.Add(",\"curve\":");
  AddList(text, ",", curve, [&](const WorldPoint& p) { AddPosition(text, p); });
}

void AddEdge(Text& text, const SkeletonGraph& graph, size_t n, const EdgeContext& context,
             RadiusTexts& radii) {
  const SkeletonEdge& edge = graph.edges[n];
  const std::vector<WorldPoint> curve = SmoothCurve(graph, edge);
  text.Add("{\"source\":", edge.source, ",\"target\":", edge.target);
  if (context.parts == JsonParts::kAll) AddPoints(text, graph, edge, curve, context, radii);
  const EdgeFigures figures = FiguresOf(graph, edge, curve);
  text.Add(",\"length\":", figures.length, ",\"mean_radius\":", figures.mean_radius,
           ",\"min_radius\":", figures.min_radius, ",\"max_radius\":", figures.max_radius);
  if (figures.tortuosity.has_value()) text.Add(",\"tortuosity\":", *figures.tortuosity);
  if (std::isfinite(edge.pruning_level)) text.Add(",\"pruning_level\":", edge.pruning_level);
  if (context.order.has_value()) {
    AddEdgeOrder(text, context.order->edges[n]);
  }
  text.Add('}');
}

void AddSheets(Text& text, const SkeletonGraph& graph, RadiusTexts& radii) {
  text.Add("{\"points\":");
  AddList(text, ",", graph.sheets,
          [&](const SkeletonPoint& p) { AddPosition(text, graph.PositionOf(p)); });
  text.Add(",\"radii\":");
  AddList(text, ",", graph.sheets, [&](const SkeletonPoint& p) { text.Add(radii.Of(p)); });
  if (graph.HasBirths()) {
    text.Add(",\"births\":");
    AddList(text, ",", graph.sheets, [&](const SkeletonPoint& p) { text.Add(p.birth); });
  }
  text.Add('}');
}

void AddOrder(Text& text, const TreeOrder& order) {
  text.Add(",\n\"order\":{\"roots\":");
  AddList(text, ",", order.roots, [&](uint32_t root) { text.Add(root); });
  if (order.rule == RootChoice::Rule::kDeepestNode) text.Add(",\"rule\":\"thickest-node\"");
  text.Add(",\"loops_cut\":", order.loops_cut, ",\"most_generations\":", order.MostGenerations(),
           ",\"highest_strahler\":", order.HighestStrahler(), '}');
}

void AddFigures(Text& text, const ComponentFigures& figures) {
  text.Add("{\"nodes\":", figures.nodes, ",\"edges\":", figures.edges, ",\"ends\":", figures.ends,
           ",\"junctions\":", figures.junctions, ",\"loops\":", figures.loops,
           ",\"cavities\":", figures.cavities, ",\"length\":", figures.length,
           ",\"max_radius\":", figures.max_radius, '}');
}

double Milliseconds(StageTimings::Duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

void AddTimings(Text& text, const StageTimings& timings) {
  text.Add(",\n\"timings\":{");
  for (const Stage& stage : kStages) {
    text.Add('"', stage.name, "_ms\":", Milliseconds(timings.*stage.time), ',');
  }
  text.Add("\"total_ms\":", Milliseconds(timings.total), '}');
}

}  // namespace

std::string JsonText(const SkeletonizeResult& result, const std::optional<TreeOrder>& order,
                     const World& world, JsonParts parts, const exec::Context& context) {
  const SkeletonGraph& graph = result.graph;
  Text text(context.stop);
  // Too much rather than too little: memory that is not written to costs nothing.
  text.Reserve(4096 + 150 * graph.nodes.size() + 400 * graph.edges.size() +
               100 * (graph.points.size() + graph.sheets.size()));
  text.Add("{\n\"nodes\":");
  const GraphComponents components = ComponentsOf(graph, context.stop);
  text.Add('[');
  AddShared(text, graph.nodes.size(), context, [&] {
    return [&](Text& piece, size_t n) {
      piece.Add(n == 0 ? "" : kBetweenItems);
      AddNode(piece, graph, n, components.of_node[n], order);
    };
  });
  const EdgeContext edges = {order, graph.HasBirths(), graph.HasShifts(), parts};
  text.Add("],\n\"edges\":[");
  AddShared(text, graph.edges.size(), context, [&] {
    return [&, radii = RadiusTexts(graph)](Text& piece, size_t n) mutable {
      piece.Add(n == 0 ? "" : kBetweenItems);
      AddEdge(piece, graph, n, edges, radii);
    };
  });
  text.Add(']');
  if (parts == JsonParts::kAll) {
    RadiusTexts radii(graph);
    text.Add(",\n\"sheets\":");
    AddSheets(text, graph, radii);
  }
  text.Add(",\n\"components\":");
  AddList(text, ",\n", components.figures,
          [&](const ComponentFigures& figures) { AddFigures(text, figures); });
  text.Add(",\n\"totals\":");
  AddFigures(text, TotalOf(components));
  if (order.has_value()) AddOrder(text, *order);
  text.Add(",\n\"certificate\":", CertificateJson(result.certificate),
           ",\n\"method\":", JsonString(result.method),
           ",\n\"algorithm_version\":", JsonString(result.algorithm_version),
           ",\n\"options\":", OptionsJson(result.options),
           ",\n\"preparing\":", PreparingJson(result.preparing), ",\n\"notes\":");
  AddList(text, ",\n", NotesOn(result),
          [&](const std::string& note) { text.Add(JsonString(note)); });
  text.Add(",\n\"placement\":{", PlacementJson(graph.placement),
           "},\n\"world\":", JsonString(OrUnknown(world.axes)),
           ",\n\"unit\":", JsonString(OrUnknown(world.unit)),
           ",\n\"object_points\":", result.object_points);
  if (parts == JsonParts::kAll) AddTimings(text, result.timings);
  text.Add(",\n\"sha256\":", JsonString(result.sha256), "\n}\n");
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
