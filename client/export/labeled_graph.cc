#include "client/export/labeled_graph.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "client/export/atomic_file.h"
#include "client/export/branch_table.h"
#include "client/export/glb.h"
#include "client/export/graphml.h"
#include "client/export/json.h"
#include "client/export/markups.h"
#include "client/export/precomputed.h"
#include "client/export/vtp.h"
#include "core/exec/status_macros.h"

namespace bccskel::exporting {
namespace {

std::optional<TreeOrder> OrderOf(const SkeletonGraph& graph,
                                 const std::optional<RootChoice>& root) {
  if (!root.has_value()) return std::nullopt;
  return OrderTrees(graph, *root);
}

}  // namespace

void LabeledSkeletons::Add(uint64_t label, uint64_t voxels, const SkeletonizeResult& result) {
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
           ",\"skeleton\":" + JsonText(result, OrderOf(graph, root_), world_) + "}";
}

GraphContext LabeledSkeletons::Context() const {
  return {.labels = labels_, .facts = facts_, .order = OrderOf(graph_, root_)};
}

std::string LabeledSkeletons::Markups() const {
  return WriteMarkups(graph_, Context(), world_).text;
}

absl::StatusOr<std::string> LabeledSkeletons::WritePrecomputedFolder(
    const std::string& path, const std::stop_token& stop) const {
  return WritePrecomputed(path, graph_, {.labels = labels_, .world = world_, .sampling = {}}, stop);
}

namespace {

absl::StatusOr<std::string> BytesOf(SkeletonFormat format, const LabeledSkeletons& skeletons) {
  switch (format) {
    case SkeletonFormat::kVtp:
      return VtpText(skeletons.graph(), skeletons.Context());
    case SkeletonFormat::kGraphMl:
      return GraphMlText(skeletons.graph(), skeletons.Context());
    case SkeletonFormat::kJson:
      return skeletons.Json();
    case SkeletonFormat::kCsv:
      return BranchTableText(skeletons.graph(), skeletons.Context());
    case SkeletonFormat::kMarkups:
      return skeletons.Markups();
    case SkeletonFormat::kGlb:
      return GlbBytes(skeletons.graph(), skeletons.Context(), skeletons.world());
    default:
      return absl::InvalidArgumentError("this format holds one label");
  }
}

}  // namespace

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
  if (format == SkeletonFormat::kPrecomputed) return skeletons.WritePrecomputedFolder(path, stop);
  const absl::StatusOr<std::string> bytes = BytesOf(format, skeletons);
  if (!bytes.ok()) {
    return absl::Status(bytes.status().code(), absl::StrCat(path, ": ", bytes.status().message()));
  }
  BCCSKEL_RETURN_IF_ERROR(WriteFileAtomically(path, *bytes, stop));
  return format == SkeletonFormat::kMarkups ? NoteOn(skeletons.world()) : "";
}

}  // namespace bccskel::exporting
