#include "client/export/subject_document.h"

#include <optional>
#include <string>

#include "client/export/json.h"
#include "core/exec/status_macros.h"
#include "core/skeleton/node_kind_name.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

using view::ResultDocument;

// Everything but the graph, which alone can be large.
absl::StatusOr<ResultDocument> FactsOf(const SkeletonizeResult& result, const World& world) {
  SkeletonizeResult facts;
  facts.graph.placement = result.graph.placement;
  facts.certificate = result.certificate;
  facts.options = result.options;
  facts.preparing = result.preparing;
  facts.object_points = result.object_points;
  facts.method = result.method;
  facts.algorithm_version = result.algorithm_version;
  BCCSKEL_ASSIGN_OR_RETURN(ResultDocument document,
                           view::ParseResultDocument(JsonText(facts, std::nullopt, world)));
  document.text = nullptr;
  document.not_on_pages.clear();
  return document;
}

ResultDocument::Node NodeOf(const SkeletonGraph& graph, const SkeletonNode& node) {
  return {.kind = std::string(NodeKindName(node.kind)),
          .position = graph.PositionOf(node.at),
          .radius = graph.RadiusOf(node.at),
          .birth = node.at.birth,
          .loops = node.loops,
          .cavities = node.cavities};
}

// Needs: the lists of points have their lengths.
void SetEdge(const SkeletonGraph& graph, size_t n, ResultDocument& document) {
  const SkeletonEdge& from = graph.edges[n];
  const std::vector<WorldPoint> curve = SmoothCurve(graph, from);
  document.edges[n] = {.source = from.source,
                       .target = from.target,
                       .first_point = from.first_point,
                       .point_count = from.point_count,
                       .length = FiguresOf(graph, from, curve).length,
                       .pruning_level = from.pruning_level};
  for (size_t k = 0; k < from.point_count; ++k) {
    const size_t at = from.first_point + k;
    const SkeletonPoint& p = graph.points[at];
    document.points[at] = graph.PositionOf(p);
    document.radii[at] = graph.RadiusOf(p);
    document.curves[at] = curve[k];
    if (!document.births.empty()) document.births[at] = p.birth;
    if (!document.shifts.empty()) document.shifts[at] = p.shift;
  }
}

void AddSheets(const SkeletonGraph& graph, bool births, ResultDocument::Sheets& sheets) {
  for (const SkeletonPoint& p : graph.sheets) {
    sheets.points.push_back(graph.PositionOf(p));
    sheets.radii.push_back(graph.RadiusOf(p));
    if (births) sheets.births.push_back(p.birth);
  }
}

ResultDocument::Labels LabelsOf(const SubjectLabels& subject) {
  const GraphLabels& rows = subject.of_rows;
  return {rows.names, PlacesOf(rows.of_nodes, rows.names), PlacesOf(rows.of_sheets, rows.names)};
}

}  // namespace

absl::StatusOr<ResultDocument> DocumentOf(const Subject& subject) {
  const exec::Context& context = subject.context;
  BCCSKEL_ASSIGN_OR_RETURN(ResultDocument document, FactsOf(subject.result, subject.world));
  if (subject.labels.has_value()) document.labels = LabelsOf(*subject.labels);
  const SkeletonGraph& graph = subject.result.graph;
  const bool births = graph.HasBirths();
  constexpr size_t kAtOnce = 1024;
  const auto add_nodes = [&](exec::Share share) {
    for (size_t n = share.begin; n < share.end; ++n) {
      document.nodes[n] = NodeOf(graph, graph.nodes[n]);
    }
  };
  document.nodes.resize(graph.nodes.size());
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(graph.nodes.size(), kAtOnce, add_nodes));
  const auto add_edges = [&](exec::Share share) {
    for (size_t n = share.begin; n < share.end; ++n) {
      SetEdge(graph, n, document);
    }
  };
  const size_t points = graph.points.size();
  document.edges.resize(graph.edges.size());
  document.points.resize(points);
  document.radii.resize(points);
  document.curves.resize(points);
  if (births) document.births.resize(points);
  if (graph.HasShifts()) document.shifts.resize(points);
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(graph.edges.size(), kAtOnce, add_edges));
  AddSheets(graph, births, document.sheets);
  return document;
}

}  // namespace bccskel::exporting
