#include "client/export/labeled_graph.h"

#include <utility>

#include "client/export/atomic_file.h"
#include "client/export/json.h"
#include "core/exec/status_macros.h"

namespace bccskel::exporting {

void LabeledSkeletons::Add(uint64_t label, uint64_t voxels, const SkeletonizeResult& result,
                           const std::stop_token& stop) {
  const SkeletonGraph& graph = result.graph;
  if (facts_.empty()) {
    facts_ = MethodFactsOf(result, world_);
    // The effects of preparation differ from label to label.
    std::erase_if(facts_, [](const auto& fact) { return fact.first == "prepared"; });
  }
  const auto first_node = static_cast<uint32_t>(graph_.nodes.size());
  const size_t first_point = graph_.points.size();
  graph_.placement = graph.placement;
  graph_.nodes.insert(graph_.nodes.end(), graph.nodes.begin(), graph.nodes.end());
  graph_.points.insert(graph_.points.end(), graph.points.begin(), graph.points.end());
  for (SkeletonEdge edge : graph.edges) {
    edge.source += first_node;
    edge.target += first_node;
    edge.first_point += first_point;
    graph_.edges.push_back(edge);
  }
  graph_.sheets.insert(graph_.sheets.end(), graph.sheets.begin(), graph.sheets.end());
  labels_.of_sheets.resize(graph_.sheets.size(), label);
  labels_.of_nodes.resize(graph_.nodes.size(), label);
  labels_.of_edges.resize(graph_.edges.size(), label);
  json_ += json_.empty() ? "\n" : ",\n";
  json_ += "{\"label\":" + std::to_string(label) + ",\"voxels\":" + std::to_string(voxels) +
           ",\"skeleton\":" +
           JsonText(result, OrderOf(graph, root_, stop), world_, JsonParts::kAll, stop) + "}";
}

GraphContext LabeledSkeletons::Context(const std::stop_token& stop) const {
  return {.labels = labels_, .facts = facts_, .order = OrderOf(graph_, root_, stop), .stop = stop};
}

bool HoldsManyLabels(SkeletonFormat format) {
  return format == SkeletonFormat::kVtp || format == SkeletonFormat::kGraphMl ||
         format == SkeletonFormat::kJson || format == SkeletonFormat::kCsv ||
         format == SkeletonFormat::kGlb || format == SkeletonFormat::kMarkups ||
         format == SkeletonFormat::kPrecomputed;
}

absl::StatusOr<std::string> WriteLabeledFile(const std::string& path,
                                             const LabeledSkeletons& skeletons,
                                             const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, SkeletonFormatOf(path));
  if (!HoldsManyLabels(format)) {
    return absl::InvalidArgumentError(path + ": this format holds one label");
  }
  if (format == SkeletonFormat::kJson) {
    BCCSKEL_RETURN_IF_ERROR(WriteFileAtomically(path, skeletons.Json(), stop));
    return std::string();
  }
  return WriteGraphFile(
      path,
      {.graph = skeletons.graph(), .context = skeletons.Context(stop), .world = skeletons.world()});
}

}  // namespace bccskel::exporting
