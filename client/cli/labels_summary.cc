#include "client/cli/labels_summary.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "client/cli/json_text.h"
#include "client/cli/load_object.h"
#include "client/cli/volume_summary.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"

namespace bccskel::cli {
namespace {

using exporting::Counted;
using exporting::GroupedDigits;
using exporting::Text;

// Sums over all labels.
struct Totals {
  uint64_t voxels = 0;
  uint64_t object_points = 0;
  uint64_t skeleton_points = 0;
  uint64_t nodes = 0;
  uint64_t edges = 0;
  uint64_t simple_points_left = 0;
  BettiNumbers topology;
  BettiNumbers unprepared;               // of the labels that were prepared
  std::vector<PreparingStep> preparing;  // each step's sums; none: nothing was prepared
};

void Add(const BettiNumbers& one, BettiNumbers& sum) {
  sum.components += one.components;
  sum.loops += one.loops;
  sum.cavities += one.cavities;
}

// Every label goes through the same kinds of steps.
void Add(const std::vector<PreparingStep>& one, std::vector<PreparingStep>& sum) {
  for (const PreparingStep& step : one) {
    auto same = std::ranges::find(sum, step.kind, &PreparingStep::kind);
    if (same == sum.end()) same = sum.insert(sum.end(), {.kind = step.kind});
    same->points_added += step.points_added;
    same->points_removed += step.points_removed;
    const bool passes = step.kind == PreparingStepKind::kDenoise;
    same->count = passes ? std::max(same->count, step.count) : same->count + step.count;
  }
}

Totals TotalsOf(const std::vector<LabelFigures>& labels) {
  Totals totals;
  for (const LabelFigures& label : labels) {
    totals.voxels += label.voxels;
    totals.object_points += label.object_points;
    totals.skeleton_points += label.skeleton_points;
    totals.nodes += label.nodes;
    totals.edges += label.edges;
    totals.simple_points_left += label.certificate.simple_points_left;
    Add(label.certificate.skeleton, totals.topology);
    if (label.certificate.unprepared.has_value()) {
      Add(*label.certificate.unprepared, totals.unprepared);
    }
    Add(label.preparing, totals.preparing);
  }
  return totals;
}

void AddPreparing(Text& text, const Totals& totals) {
  if (totals.preparing.empty()) return;
  text.Add("\ngiven:     ", exporting::BettiPhrase(totals.unprepared),
           "\nprepared:  ", PreparingPhrase(totals.preparing));
}

std::string SummaryText(const LabelsSummary& summary) {
  const Totals totals = TotalsOf(summary.labels);
  const ImageSize& size = summary.info.size;
  char seconds[32];
  std::snprintf(seconds, sizeof(seconds), "%.3f", summary.seconds);
  Text text;
  text.Add("input:     ", FileName(summary.arguments.input), ", ", summary.info.format, ", ",
           size.nx, " x ", size.ny, " x ", size.nz, ' ', VoxelTypeName(summary.info.type),
           "\nlabels:    ", GroupedDigits(summary.labels.size()), ", ",
           Counted(totals.voxels, "voxel", "voxels"));
  if (summary.left_out > 0) {
    text.Add("; ", GroupedDigits(summary.left_out), " with fewer than ",
             Counted(summary.arguments.min_voxels, "voxel", "voxels"), " left out");
  }
  AddPreparing(text, totals);
  const bool sampled = summary.arguments.image.mask.sampling.has_value();
  const char* from = !totals.preparing.empty() ? "prepared object"
                     : sampled                 ? "sampled object"
                                               : "voxels";
  text.Add("\nobjects:   ", Counted(totals.object_points, "point", "points"), ", ",
           exporting::BettiPhrase(totals.topology),
           "\nskeletons: ", Counted(totals.skeleton_points, "point", "points"), ", ",
           Counted(totals.nodes, "node", "nodes"), ", ", Counted(totals.edges, "edge", "edges"),
           "\ncheck:     topology kept from every label's ", from, " on, ",
           Counted(totals.simple_points_left, "simple point", "simple points"), " left",
           sampled ? "; sampling may have changed the voxels'" : "", "\ntime:      ", seconds,
           " s\n");
  for (const WrittenFile& file : summary.files) {
    text.Add("written:   ", file.path, file.note.empty() ? "" : ", ", file.note, '\n');
  }
  return std::move(text).Take();
}

void AddLabelJson(Text& text, const LabelFigures& label) {
  const Certificate& certificate = label.certificate;
  text.Add("{\"label\":", label.label, ",\"voxels\":", label.voxels,
           ",\"object_points\":", label.object_points,
           ",\"skeleton_points\":", label.skeleton_points, ",\"nodes\":", label.nodes,
           ",\"edges\":", label.edges, ",\"certificate\":{");
  if (certificate.mask.has_value()) text.Add("\"mask\":", BettiJson(*certificate.mask), ',');
  if (certificate.unprepared.has_value()) {
    text.Add("\"unprepared\":", BettiJson(*certificate.unprepared), ',');
  }
  if (certificate.sampled) text.Add("\"sampled\":true,");
  text.Add("\"input\":", BettiJson(certificate.input),
           ",\"skeleton\":", BettiJson(certificate.skeleton),
           ",\"simple_points_left\":", certificate.simple_points_left, "},\"topology_kept\":",
           certificate.TopologyKept() && certificate.MaskKept() ? "true" : "false",
           ",\"sha256\":\"", label.sha256, "\"}");
}

std::string SummaryJson(const LabelsSummary& summary) {
  Text text;
  text.Add("{\"input\":", JsonString(summary.arguments.input), ",\"left_out\":", summary.left_out,
           ",\"labels\":[");
  for (size_t n = 0; n < summary.labels.size(); ++n) {
    if (n > 0) text.Add(',');
    AddLabelJson(text, summary.labels[n]);
  }
  text.Add("],\"seconds\":", summary.seconds, ",\"outputs\":[");
  for (size_t n = 0; n < summary.files.size(); ++n) {
    text.Add(n > 0 ? "," : "", "{\"path\":", JsonString(summary.files[n].path),
             ",\"note\":", JsonString(summary.files[n].note), '}');
  }
  text.Add("]}\n");
  return std::move(text).Take();
}

}  // namespace

LabelFigures FiguresOf(const LabelSkeleton& skeleton) {
  const SkeletonizeResult& result = skeleton.result;
  return {.label = skeleton.label,
          .voxels = skeleton.voxels,
          .object_points = result.object_points,
          .skeleton_points = result.skeleton_points,
          .nodes = result.graph.nodes.size(),
          .edges = result.graph.edges.size(),
          .certificate = result.certificate,
          .preparing = result.preparing,
          .sha256 = result.sha256};
}

std::string LabelsSummaryOf(const LabelsSummary& summary) {
  const bool json = summary.arguments.common.summary == SummaryStyle::kJson;
  return json ? SummaryJson(summary) : SummaryText(summary);
}

}  // namespace bccskel::cli
