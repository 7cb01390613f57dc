#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <memory>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/file_writers.h"
#include "client/cli/image_options.h"
#include "client/cli/label_files.h"
#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/cli/thinning_options.h"
#include "client/export/method_facts.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "client/skeletonize_client.h"
#include "core/certificate/describe_changes.h"
#include "core/exec/status_macros.h"
#include "core/import/image/image_info.h"
#include "core/import/image/open_image.h"
#include "core/labels/skeletonize_labels.h"
#include "core/pipeline/notes.h"

namespace bccskel::cli {

namespace {

// The summary of one label.
struct LabelFigures {
  uint64_t label = 0;
  uint64_t voxels = 0;
  uint64_t object_points = 0;
  uint64_t skeleton_points = 0;
  size_t nodes = 0;
  size_t edges = 0;
  Certificate certificate;
  std::vector<PreparingStep> preparing;
  std::vector<std::string> notes;
  std::string sha256;
};

// The summary of the command `labels`.
struct LabelsSummary {
  const LabelsArguments& arguments;
  const ImageInfo& info;
  uint64_t left_out = 0;
  std::vector<LabelFigures> labels;
  std::vector<WrittenFile> files;
  double seconds = 0;
};

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
  Certificate certificate;
  uint64_t changed = 0;                  // labels whose topology changed before thinning
  std::vector<PreparingStep> preparing;  // sums per step; empty: nothing was prepared
};

// All labels go through the same kinds of steps.
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

bool KeptToThinning(const Certificate& certificate) {
  return certificate.MaskKept() && certificate.Given() == certificate.input;
}

// Changes of labels may cancel out in the sums.
std::string CheckPhrase(const Totals& totals, size_t labels) {
  std::string of_all = VerdictInWords(totals.certificate);
  if (totals.changed == 0) return of_all;
  const std::string in_some =
      absl::StrFormat(", in %d of %s", totals.changed, Counted(labels, "label", "labels"));
  return (KeptToThinning(totals.certificate) ? "topology changed before thinning" : of_all) +
         in_some;
}

Totals TotalsOf(const std::vector<LabelFigures>& labels) {
  Totals totals;
  for (const LabelFigures& label : labels) {
    totals.voxels += label.voxels;
    totals.object_points += label.object_points;
    totals.skeleton_points += label.skeleton_points;
    totals.nodes += label.nodes;
    totals.edges += label.edges;
    totals.certificate += label.certificate;
    totals.changed += KeptToThinning(label.certificate) ? 0 : 1;
    Add(label.preparing, totals.preparing);
  }
  return totals;
}

void AddPreparing(Text& text, const Totals& totals) {
  if (totals.preparing.empty()) return;
  text.Add("\ngiven:     ", exporting::BettiPhrase(totals.certificate.Given()),
           "\nprepared:  ", PreparingPhrase(totals.preparing));
}

std::string SummaryText(const LabelsSummary& summary) {
  const Totals totals = TotalsOf(summary.labels);
  const ImageSize& size = summary.info.size;
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
  text.Add("\nobjects:   ", Counted(totals.object_points, "point", "points"), ", ",
           exporting::BettiPhrase(totals.certificate.input),
           "\nskeletons: ", Counted(totals.skeleton_points, "point", "points"), ", ",
           Counted(totals.nodes, "node", "nodes"), ", ", Counted(totals.edges, "edge", "edges"),
           "\ncheck:     ", CheckPhrase(totals, summary.labels.size()), ", ",
           Counted(totals.certificate.simple_points_left, "simple point", "simple points"), " left",
           "\ntime:      ", absl::StrFormat("%.3f", summary.seconds), " s ",
           WhereComputed(summary.arguments), "\n");
  text.Add(FilesText(summary.files));
  return std::move(text).Take();
}

void AddLabelJson(Text& text, const LabelFigures& label) {
  const Certificate& certificate = label.certificate;
  text.Add("{\"label\":", label.label, ",\"voxels\":", label.voxels,
           ",\"object_points\":", label.object_points,
           ",\"skeleton_points\":", label.skeleton_points, ",\"nodes\":", label.nodes,
           ",\"edges\":", label.edges, ",\"certificate\":", exporting::CertificateJson(certificate),
           ",\"topology_kept\":", KeptJson(certificate), ",\"notes\":", JsonStrings(label.notes),
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
  text.Add("],\"seconds\":", summary.seconds, ",\"outputs\":", FilesJson(summary.files), "}\n");
  return std::move(text).Take();
}

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
          .notes = NotesOn(result),
          .sha256 = result.sha256};
}

// Notes on many labels would hide each other.
void WarnOfNotes(const std::string& input, const std::vector<LabelFigures>& labels) {
  constexpr size_t kShown = 3;
  size_t noted = 0;
  for (const LabelFigures& label : labels) {
    if (label.notes.empty() || ++noted > kShown) continue;
    for (const std::string& note : label.notes) {
      Warn(absl::StrFormat("%s: label %d: %s", input, label.label, note));
    }
  }
  if (noted <= kShown) return;
  Warn(absl::StrFormat("%s: there are notes on %s; --json shows all", input,
                       Counted(noted - kShown, "more label", "more labels")));
}

// Text, or one JSON object on one line, as requested.
std::string LabelsSummaryOf(const LabelsSummary& summary) {
  const bool json = summary.arguments.common.summary == SummaryStyle::kJson;
  return json ? SummaryJson(summary) : SummaryText(summary);
}

using Clock = std::chrono::steady_clock;

absl::StatusOr<CollectedLabels> Collect(const LabelsArguments& arguments,
                                        const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const InputKind kind, InputKindOf(arguments.input, arguments.image));
  if (kind != InputKind::kImage) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "is %s, which has no labels; bccskel skeletonize takes it", InputKindPhrase(kind)));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(arguments.input, arguments.image.open));
  return CollectLabels(*source, arguments.image, arguments.min_voxels, context);
}

absl::Status NoLabels(const LabelsArguments& arguments, uint64_t left_out) {
  if (left_out == 0) return NoSuchLabel(arguments.input, arguments.image);
  return absl::InvalidArgumentError(absl::StrFormat(
      "no requested label has %d voxels or more (--min-voxels); %s fewer", arguments.min_voxels,
      exporting::Counted(left_out, "label has", "labels have")));
}

// Labels left out by their size are stated in the summary. Of a range not all need be there.
void WarnOfAbsent(const LabelsArguments& arguments, const CollectedLabels& labels) {
  constexpr size_t kShown = 10;
  const std::set<uint64_t> wanted(arguments.image.labels.begin(), arguments.image.labels.end());
  std::set<uint64_t> absent;
  for (const uint64_t label : wanted) {
    if (!wanted.contains(label - 1) && !wanted.contains(label + 1)) absent.insert(label);
  }
  for (const LabeledObject& object : labels.objects.objects) absent.erase(object.label);
  if (absent.size() <= labels.left_out) return;
  const std::string fewer =
      labels.left_out > 0
          ? absl::StrFormat("fewer than %d voxels (--min-voxels) have", arguments.min_voxels)
          : "no voxel has";
  const auto end =
      std::next(absent.begin(), static_cast<ptrdiff_t>(std::min(kShown, absent.size())));
  Warn(arguments.input + ": " + fewer + " the label " + absl::StrJoin(absent.begin(), end, ", ") +
       (absent.size() > kShown ? ", ..." : ""));
}

absl::StatusOr<CollectedLabels> Load(const LabelsArguments& arguments,
                                     const exec::Context& context) {
  absl::StatusOr<CollectedLabels> labels = Collect(arguments, context);
  if (!labels.ok()) return WithPath(labels.status(), arguments.input);
  if (labels->not_numbers > 0) Warn(arguments.input + ": " + NanWarning(labels->not_numbers));
  if (labels->objects.objects.empty()) {
    return WithPath(NoLabels(arguments, labels->left_out), arguments.input);
  }
  WarnOfAbsent(arguments, *labels);
  if (labels->gray_threshold.has_value()) {
    Warn(absl::StrFormat(
        "%s: the values look like gray levels, not labels, and each value is an object; bccskel "
        "skeletonize --threshold %g (Otsu's) takes the brighter voxels for one",
        arguments.input, *labels->gray_threshold));
  }
  return labels;
}

absl::Status OnServer(const LabelsArguments& arguments, const LabeledObjects& labels,
                      const LabelConsumer& consume, const std::stop_token& stop) {
  const client::DenseLabels image = client::DenseLabelsOf(labels);
  client::LabelsCallOptions options;
  options.skeletonize = arguments.skeletonize;
  options.adjacency = arguments.image.mask.adjacency;
  options.points = arguments.image.mask.points;
  options.threads = arguments.common.threads;
  options.timeout = arguments.timeout;
  options.stop = stop;
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(arguments.server));
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<client::Stub> stub, client::MakeGrpcStub(endpoint));
  return client::SkeletonizeClient(std::move(stub))
      .SkeletonizeLabels({labels.grid, image.label_bytes, image.voxels}, options, consume)
      .status();
}

absl::Status Compute(const LabelsArguments& arguments, const LabeledObjects& labels,
                     const LabelConsumer& consume, exec::Context context) {
  if (arguments.place == Place::kServer) {
    return OnServer(arguments, labels, consume, context.stop);
  }
  context.deadline = Clock::now() + arguments.timeout;
  return SkeletonizeLabels(
      labels, {.mask = arguments.image.mask, .skeleton = arguments.skeletonize}, consume, context);
}

}  // namespace

void AddLabels(CLI::App& command, LabelsArguments& arguments) {
  AddInput(command, "IMAGE", arguments.input, "Image file of labels");
  AddOutputs(command, arguments.outputs,
             "with {label} in its path one file per label, in any format; else all labels in a "
             ".vtp, .graphml, .json, .csv, .glb, .html, .svg, .png, .mrk.json or .precomputed");
  AddSwcStep(command, arguments.swc);
  AddLabelImage(command, arguments.image);
  AddMinVoxels(command, arguments.min_voxels);
  AddPlace(command, arguments.server, arguments.place);
  AddComputing(command, arguments);
}

ExitCode Run(const LabelsArguments& arguments, const std::stop_token& stop) {
  const Clock::time_point start = Clock::now();
  LocalTeam team(arguments.common.threads, stop);
  ProgressBar bar(arguments.common.progress);
  bar.Begin("reading", arguments.input);
  const absl::StatusOr<CollectedLabels> labels = Load(arguments, team.context());
  if (!labels.ok()) return Fail(labels.status());
  LabelFiles files(arguments, *labels, team.context().threads(), stop);
  std::vector<LabelFigures> figures;
  absl::Status writing, computed;
  const auto on_label = bar.LabelsCallback("skeletonizing the first labels");
  // Writes each label's files as soon as it is done.
  const auto deliver = [&](LabelSkeleton&& skeleton) {
    figures.push_back(FiguresOf(skeleton));
    writing = files.Add(std::move(skeleton));
    if (on_label) on_label(figures.size(), labels->objects.objects.size());
    return writing;
  };
  computed = Compute(arguments, labels->objects, deliver, team.context());
  if (!writing.ok()) return FailWith(ExitCode::kOutput, writing);
  if (!computed.ok()) return FailComputing(arguments, computed);
  WarnOfNotes(arguments.input, figures);
  absl::StatusOr<std::vector<WrittenFile>> written = std::move(files).Finish(bar, team.context());
  if (!written.ok()) return FailWith(ExitCode::kOutput, written.status());
  return Print(LabelsSummaryOf({arguments, labels->info, labels->left_out, std::move(figures),
                                *std::move(written),
                                std::chrono::duration<double>(Clock::now() - start).count()}));
}

}  // namespace bccskel::cli
