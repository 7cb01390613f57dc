#include "client/export/labeled_graph.h"

#include <algorithm>
#include <utility>

#include "client/export/atomic_file.h"
#include "client/export/json.h"
#include "core/certificate/describe_changes.h"
#include "core/exec/status_macros.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

namespace {

constexpr size_t kMostLabelTriangles = 200'000;

void AddTo(SkeletonGraph& all, const SkeletonGraph& graph) {
  const auto first_node = static_cast<uint32_t>(all.nodes.size());
  const size_t first_point = all.points.size();
  all.placement = graph.placement;
  all.nodes.insert(all.nodes.end(), graph.nodes.begin(), graph.nodes.end());
  all.points.insert(all.points.end(), graph.points.begin(), graph.points.end());
  for (SkeletonEdge edge : graph.edges) {
    edge.source += first_node;
    edge.target += first_node;
    edge.first_point += first_point;
    all.edges.push_back(edge);
  }
  all.sheets.insert(all.sheets.end(), graph.sheets.begin(), graph.sheets.end());
}

}  // namespace

LabeledSkeletons::LabeledSkeletons(const std::vector<std::string>& paths,
                                   const std::optional<RootChoice>& root, World world)
    : root_(root), world_(std::move(world)) {
  for (const std::string& path : paths) {
    const absl::StatusOr<SkeletonFormat> format = SkeletonFormatOf(path);
    if (!format.ok()) continue;
    keeps_json_ |= *format == SkeletonFormat::kJson;
    shows_objects_ |= ShowsObject(*format);
  }
}

void LabeledSkeletons::Add(uint64_t label, uint64_t voxels, const SkeletonizeResult& result,
                           const std::stop_token& stop) {
  if (sizes_.empty()) {
    facts_ = MethodFactsOf(result, world_);
    // The effects of preparation differ from label to label.
    std::erase_if(
        facts_, [](const auto& fact) { return fact.first == "prepared" || fact.first == "check"; });
    all_.options = result.options;
    all_.method = result.method;
    all_.algorithm_version = result.algorithm_version;
  }
  sizes_.push_back(std::max(voxels, result.object_points));
  labels_.names.push_back(label);
  AddTo(all_.graph, result.graph);
  all_.certificate += result.certificate;
  all_.object_points += result.object_points;
  all_.skeleton_points += result.skeleton_points;
  labels_.of_sheets.resize(all_.graph.sheets.size(), label);
  labels_.of_nodes.resize(all_.graph.nodes.size(), label);
  labels_.of_edges.resize(all_.graph.edges.size(), label);
  if (!keeps_json_) return;
  exec::Context alone;
  alone.stop = stop;
  json_ += json_.empty() ? "\n" : ",\n";
  json_ += "{\"label\":" + std::to_string(label) + ",\"voxels\":" + std::to_string(voxels) +
           ",\"skeleton\":" +
           JsonText(result, OrderOf(result.graph, root_, stop), world_, JsonParts::kAll, alone) +
           "}";
}

absl::Status LabeledSkeletons::AddObjects(const view::ObjectOfLabel& object,
                                          const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(surfaces_,
                           view::SurfacesOfLabels(sizes_, object, kMostLabelTriangles, context));
  BCCSKEL_ASSIGN_OR_RETURN(all_.sha256, SkeletonDigest(all_.graph, context));
  return absl::OkStatus();
}

GraphContext LabeledSkeletons::Context(const exec::Context& exec) const {
  MethodFacts facts = facts_;
  facts.emplace_back("check", VerdictInWords(all_.certificate));
  return {.labels = labels_,
          .facts = std::move(facts),
          .order = OrderOf(all_.graph, root_, exec.stop),
          .exec = exec};
}

bool HoldsManyLabels(SkeletonFormat format) {
  return format != SkeletonFormat::kSwc && format != SkeletonFormat::kObj &&
         format != SkeletonFormat::kVolume;
}

absl::StatusOr<std::string> WriteLabeledFile(const std::string& path,
                                             const LabeledSkeletons& skeletons,
                                             const LabeledPicture& picture) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, SkeletonFormatOf(path));
  const std::stop_token& stop = picture.context.stop;
  if (!HoldsManyLabels(format)) {
    return absl::InvalidArgumentError(path + ": this format holds one label");
  }
  if (format == SkeletonFormat::kJson) {
    BCCSKEL_RETURN_IF_ERROR(WriteFileAtomically(path, skeletons.Json(), stop));
    return std::string();
  }
  const GraphContext context = skeletons.Context(picture.context);
  if (!ShowsObject(format)) {
    return WriteGraphFile(
        path, {.graph = skeletons.all().graph, .context = context, .world = skeletons.world()});
  }
  return WriteSkeletonFile(path, {.result = skeletons.all(),
                                  .object = skeletons.all().thin,
                                  .title = picture.title,
                                  .context = picture.context,
                                  .root = skeletons.root(),
                                  .world = skeletons.world(),
                                  .draw = picture.draw,
                                  .labels = SubjectLabels{context.labels, skeletons.surfaces()}});
}

}  // namespace bccskel::exporting
