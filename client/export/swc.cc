#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "client/export/graph_formats.h"
#include "client/export/point_forest.h"

namespace bccskel::exporting {
namespace {

enum class SwcType : int { kUndefined = 0, kSoma = 1, kFork = 5, kEnd = 6 };

// Roots chosen as the thickest nodes are somas; readers look for type 1.
enum class Roots { kSomas, kLikeOthers };

Roots RootsOf(const std::optional<TreeOrder>& order) {
  const bool somas = order.has_value() && order->rule == RootChoice::Rule::kDeepestNode;
  return somas ? Roots::kSomas : Roots::kLikeOthers;
}

SwcType TypeOf(const SkeletonGraph& graph, const PointForest::Point& point, Roots roots) {
  if (roots == Roots::kSomas && !point.parent.has_value()) return SwcType::kSoma;
  const std::optional<uint32_t> node = point.node;
  if (!node.has_value()) return SwcType::kUndefined;
  const NodeKind kind = graph.nodes[*node].kind;
  if (kind == NodeKind::kJunction) return SwcType::kFork;
  return kind == NodeKind::kEnd ? SwcType::kEnd : SwcType::kUndefined;
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

// Small sheets are thick spots of curves and need no note.
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
             surfaces == 1 ? " closed surface shown as a point"
                           : " closed surfaces shown as a point each");
    if (const uint64_t loops = LoopsStatedByNodes(graph); loops > 0) {
      note.Add(", with ", loops, loops == 1 ? " loop" : " loops", " of their own");
    }
  }
  return std::move(note).Take();
}

std::string_view CurveWord(const CurveSampling& sampling) {
  return sampling.step == 0.0 ? "lattice points, not smoothed" : "smooth";
}

void AddHeader(Text& text, const PointForest& forest, const SwcOptions& options, Roots roots,
               const std::string& note) {
  text.Add("# curve skeleton by bccskel, ", forest.trees,
           forest.trees == 1 ? " tree\n" : " trees\n");
  if (!note.empty()) text.Add("# ", note, '\n');
  AddComments(text, options.facts);
  text.Add("# curve: ", CurveWord(options.sampling), '\n');
  text.Add("# types: ", roots == Roots::kSomas ? "1 soma, " : "",
           "6 end, 5 junction, 0 other\n# id type x y z radius parent\n");
}

// Decimals for a resolution of a ten-thousandth of the spacing; none if a double has fewer.
std::optional<int> DecimalsFor(const Placement& placement) {
  const double decimals = std::ceil(4 - std::log10(std::ranges::min(placement.spacing)));
  if (!(decimals <= std::numeric_limits<double>::max_digits10)) return std::nullopt;
  return static_cast<int>(std::max(decimals, 0.0));
}

void AddRow(Text& text, size_t row, SwcType type, const PointForest::Point& point,
            std::optional<int> decimals) {
  text.Add(row + 1, ' ', static_cast<int>(type));
  for (const double value : {point.at[0], point.at[1], point.at[2], point.radius}) {
    text.Add(' ');
    if (decimals.has_value()) {
      text.AddRounded(value, *decimals);
    } else {
      text.Add(value);
    }
  }
  if (point.parent.has_value()) {
    text.Add(' ', *point.parent + 1, '\n');
  } else {
    text.Add(" -1\n");
  }
}

}  // namespace

Document WriteSwc(const SkeletonGraph& graph, const std::optional<TreeOrder>& order,
                  const SwcOptions& options) {
  const PointForest forest = PointForestOf(
      graph,
      order.has_value() ? *order
                        : OrderTrees(graph, {RootChoice::Rule::kDeepestNode}, options.stop),
      options.sampling, options.stop);
  std::string note = NoteOf(graph, forest);
  Text text(options.stop);
  const Roots roots = RootsOf(order);
  AddHeader(text, forest, options, roots, note);
  const std::optional<int> decimals = DecimalsFor(graph.placement);
  for (size_t n = 0; n < forest.points.size() && !text.stopped(); ++n) {
    const PointForest::Point& point = forest.points[n];
    AddRow(text, n, TypeOf(graph, point, roots), point, decimals);
  }
  return {std::move(text).Take(), std::move(note)};
}

}  // namespace bccskel::exporting
