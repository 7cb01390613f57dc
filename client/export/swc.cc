#include "client/export/swc.h"

#include <map>
#include <string_view>
#include <utility>

#include "client/export/point_forest.h"
#include "client/export/text.h"

namespace bccskel::exporting {
namespace {

enum class SwcType : int { kUndefined = 0, kFork = 5, kEnd = 6 };

std::map<LatticePoint, SwcType> TypesOf(const SkeletonGraph& graph) {
  std::map<LatticePoint, SwcType> types;
  for (const SkeletonNode& node : graph.nodes) {
    if (node.kind == NodeKind::kEnd) types[node.at.point] = SwcType::kEnd;
    if (node.kind == NodeKind::kJunction) types[node.at.point] = SwcType::kFork;
  }
  return types;
}

uint64_t LoopsStatedByNodes(const SkeletonGraph& graph) {
  uint64_t loops = 0;
  for (const SkeletonNode& node : graph.nodes) loops += node.loops;
  return loops;
}

uint64_t ClosedSurfaces(const SkeletonGraph& graph) {
  uint64_t count = 0;
  for (const SkeletonNode& node : graph.nodes) count += node.kind == NodeKind::kClosedSurface;
  return count;
}

// Not worth a word where they are the thick spots of curves.
bool HasLargeSheets(const SkeletonGraph& graph) {
  return graph.sheets.size() > (graph.nodes.size() + graph.points.size()) / 4;
}

std::string NoteOf(const SkeletonGraph& graph, const PointForest& forest) {
  Text note;
  if (HasLargeSheets(graph)) {
    note.Add("SWC holds curves only: ", graph.sheets.size(), " points of sheets left out");
  }
  const std::string_view trees =
      HasLargeSheets(graph) ? "; trees only: " : "SWC holds trees only: ";
  if (forest.loops_cut > 0) {
    note.Add(trees, forest.loops_cut, forest.loops_cut == 1 ? " loop" : " loops",
             " cut, each at the step farthest from its root");
  }
  if (const uint64_t surfaces = ClosedSurfaces(graph); surfaces > 0) {
    note.Add(forest.loops_cut > 0 ? "; " : trees, surfaces,
             " closed surface(s) shown as a point each, with ", LoopsStatedByNodes(graph),
             " loop(s) of their own");
  }
  return std::move(note).Take();
}

void AddHeader(Text& text, const PointForest& forest, const std::string& note) {
  text.Add("# curve skeleton by bccskel, ", forest.trees, " tree(s)\n");
  if (!note.empty()) text.Add("# ", note, '\n');
  text.Add("# types: 6 end, 5 junction, 0 other\n# id type x y z radius parent\n");
}

}  // namespace

SwcDocument WriteSwc(const SkeletonGraph& graph, const std::optional<TreeOrder>& order) {
  std::vector<LatticePoint> roots;
  if (order.has_value()) {
    for (uint32_t root : order->roots) roots.push_back(graph.nodes[root].at.point);
  }
  const PointForest forest = PointForestOf(graph, roots);
  const std::map<LatticePoint, SwcType> types = TypesOf(graph);
  SwcDocument document;
  document.note = NoteOf(graph, forest);
  Text text;
  AddHeader(text, forest, document.note);
  for (size_t n = 0; n < forest.points.size(); ++n) {
    const SkeletonPoint& point = forest.points[n];
    const WorldPoint p = graph.PositionOf(point);
    const auto type = types.find(point.point);
    text.Add(n + 1, ' ', static_cast<int>(type == types.end() ? SwcType::kUndefined : type->second),
             ' ', p[0], ' ', p[1], ' ', p[2], ' ', graph.RadiusOf(point), ' ');
    if (forest.parents[n].has_value()) {
      text.Add(*forest.parents[n] + 1, '\n');
    } else {
      text.Add("-1\n");
    }
  }
  document.text = std::move(text).Take();
  return document;
}

}  // namespace bccskel::exporting
