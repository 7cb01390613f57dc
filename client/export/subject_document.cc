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

// Points with their radii and, if any point of the graph has one, births.
template <typename Points, typename To>
void AddPoints(const SkeletonGraph& graph, const Points& points, bool births, To& to) {
  to.points.reserve(points.size());
  to.radii.reserve(points.size());
  for (const SkeletonPoint& p : points) {
    to.points.push_back(graph.PositionOf(p));
    to.radii.push_back(graph.RadiusOf(p));
    if (births) to.births.push_back(p.birth);
  }
}

ResultDocument::Node NodeOf(const SkeletonGraph& graph, const SkeletonNode& node) {
  return {.kind = std::string(NodeKindName(node.kind)),
          .position = graph.PositionOf(node.at),
          .radius = graph.RadiusOf(node.at),
          .birth = node.at.birth,
          .loops = node.loops,
          .cavities = node.cavities};
}

ResultDocument::Edge EdgeOf(const SkeletonGraph& graph, const SkeletonEdge& from, bool births,
                            bool shifts) {
  ResultDocument::Edge edge = {.source = from.source,
                               .target = from.target,
                               .points = {},
                               .radii = {},
                               .births = {},
                               .shifts = {},
                               .length = FiguresOf(graph, from).length,
                               .pruning_level = from.pruning_level};
  AddPoints(graph, graph.PointsOf(from), births, edge);
  if (!shifts) return edge;
  for (const SkeletonPoint& p : graph.PointsOf(from)) edge.shifts.push_back(p.shift);
  return edge;
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
  const bool births = graph.HasBirths(), shifts = graph.HasShifts();
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
      document.edges[n] = EdgeOf(graph, graph.edges[n], births, shifts);
    }
  };
  document.edges.resize(graph.edges.size());
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(graph.edges.size(), kAtOnce, add_edges));
  AddPoints(graph, graph.sheets, births, document.sheets);
  return document;
}

}  // namespace bccskel::exporting
