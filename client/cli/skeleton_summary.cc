#include <string_view>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/cli/summaries.h"
#include "client/export/method_facts.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "core/certificate/describe_changes.h"
#include "core/pipeline/notes.h"
#include "core/pipeline/option_words.h"

namespace bccskel::cli {
namespace {

using exporting::BettiPhrase;
using exporting::Counted;
using exporting::GroupedDigits;
using exporting::Text;

double Seconds(StageTimings::Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::string Decimals(double seconds) { return absl::StrFormat("%.3f", seconds); }

std::string CheckPhrase(const Certificate& certificate) {
  std::string verdict = VerdictInWords(certificate);
  if (!certificate.TopologyKept()) return verdict;
  return verdict + ", " + Counted(certificate.simple_points_left, "simple point", "simple points") +
         " left";
}

void AddOrder(Text& text, const SkeletonSummary& summary) {
  const TreeOrder order = OrderTrees(summary.result.graph, *summary.arguments.root);
  text.Add("order:     ", Counted(order.roots.size(), "tree", "trees"), ", ",
           Counted(order.MostGenerations() + 1, "generation", "generations"), ", Strahler order ",
           order.HighestStrahler());
  if (order.loops_cut > 0) {
    text.Add("; ", Counted(order.loops_cut, "edge that closes a loop", "edges that close loops"),
             " left out");
  }
  text.Add('\n');
}

void AddTimes(Text& text, const SkeletonSummary& summary) {
  const StageTimings& timings = summary.result.timings;
  text.Add("time:      ", Decimals(summary.seconds), " s ", WhereComputed(summary.arguments),
           ", of which skeleton ", Decimals(Seconds(timings.total)));
  for (const Stage& stage : kStages) {
    text.Add(&stage == kStages.data() ? " (" : ", ", stage.name, ' ',
             Decimals(Seconds(timings.*stage.time)));
  }
  text.Add(")\n");
}

void AddTimingsJson(Text& text, const StageTimings& timings) {
  text.Add('{');
  for (const Stage& stage : kStages) {
    text.Add('"', stage.name, "_ms\":", 1e3 * Seconds(timings.*stage.time), ',');
  }
  text.Add("\"total_ms\":", 1e3 * Seconds(timings.total), '}');
}

}  // namespace

std::string WhereComputed(const ComputeArguments& arguments) {
  return "on " + (arguments.place == Place::kServer ? arguments.server.address : "this machine");
}

std::string_view KeptJson(const Certificate& certificate) {
  return certificate.TopologyKept() && certificate.MaskKept() ? "true" : "false";
}

std::string PreparingPhrase(const std::vector<PreparingStep>& steps) {
  Text text;
  for (const PreparingStep& step : steps) {
    text.Add(&step == steps.data() ? "" : ", ", WordsFor(step));
    if (step.points_added > 0) text.Add(" +", GroupedDigits(step.points_added));
    if (step.points_removed > 0) text.Add(" -", GroupedDigits(step.points_removed));
  }
  return std::move(text).Take();
}

std::string SkeletonSummaryText(const SkeletonSummary& summary) {
  const SkeletonizeResult& result = summary.result;
  const Certificate& certificate = result.certificate;
  Text text;
  text.Add("input:     ", FileName(summary.arguments.input));
  if (summary.mesh.has_value()) text.Add(", ", MeshPhrase(summary.mesh->mesh));
  if (summary.mesh.has_value() && summary.mesh->added_points > 0) {
    text.Add("\nthin:      ", ThinPartsPhrase(*summary.mesh));
  }
  if (summary.image.has_value()) text.Add(", ", ImagePhrase(*summary.image));
  if (certificate.mask.has_value()) text.Add("\nmask:      ", BettiPhrase(*certificate.mask));
  if (certificate.unprepared.has_value()) {
    text.Add("\ngiven:     ", BettiPhrase(*certificate.unprepared),
             "\nprepared:  ", PreparingPhrase(result.preparing));
  }
  text.Add("\nobject:    ", Counted(result.object_points, "point", "points"), ", ",
           BettiPhrase(certificate.input), "\nmethod:    ", result.method, '\n');
  text.Add("skeleton:  ", Counted(result.skeleton_points, "point", "points"), ", ",
           BettiPhrase(certificate.skeleton), ", ",
           Counted(result.graph.nodes.size(), "node", "nodes"), ", ",
           Counted(result.graph.edges.size(), "edge", "edges"), '\n');
  if (summary.arguments.root.has_value()) AddOrder(text, summary);
  text.Add("check:     ", CheckPhrase(certificate), '\n');
  AddTimes(text, summary);
  text.Add("sha256:    ", result.sha256, '\n');
  text.Add(FilesText(summary.files));
  return std::move(text).Take();
}

std::string SkeletonSummaryJson(const SkeletonSummary& summary) {
  const SkeletonizeResult& result = summary.result;
  const Certificate& certificate = result.certificate;
  Text text;
  text.Add("{\"input\":", JsonString(summary.arguments.input),
           ",\"volume\":", VolumeJson(summary.object, std::nullopt));
  if (summary.mesh.has_value()) text.Add(',', MeshStageJson(*summary.mesh));
  if (summary.image.has_value()) text.Add(",\"image\":", ImageJson(*summary.image));
  text.Add(",\"method\":\"", WordFor(kMethodWords, result.options.thinning.method),
           "\",\"kind\":\"", WordFor(kKindWords, result.options.thinning.kind),
           "\",\"distance\":\"", WordFor(kDistanceWords, result.options.distance),
           "\",\"object_points\":", result.object_points,
           ",\"skeleton_points\":", result.skeleton_points, ",\"last_shell\":", result.last_shell,
           ",\"nodes\":", result.graph.nodes.size(), ",\"edges\":", result.graph.edges.size());
  text.Add(",\"certificate\":", exporting::CertificateJson(certificate),
           ",\"topology_kept\":", KeptJson(certificate), ",\"sha256\":\"", result.sha256,
           "\",\"preparing\":", exporting::PreparingJson(result.preparing),
           ",\"notes\":", JsonStrings(NotesOn(result)), ",\"timings\":");
  AddTimingsJson(text, result.timings);
  text.Add(",\"seconds\":", summary.seconds, ",\"outputs\":", FilesJson(summary.files), "}\n");
  return std::move(text).Take();
}

}  // namespace bccskel::cli
