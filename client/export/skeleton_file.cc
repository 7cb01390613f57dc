#include "client/export/skeleton_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "absl/strings/ascii.h"
#include "client/export/atomic_file.h"
#include "client/export/graph_formats.h"
#include "client/export/json.h"
#include "client/export/picture/svg.h"
#include "client/export/subject_document.h"
#include "client/view/page.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_file.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

struct Ending {
  std::string_view text;
  SkeletonFormat format;
};
constexpr std::array<Ending, 14> kEndings = {{{".swc", SkeletonFormat::kSwc},
                                              // before .json, in which it ends
                                              {".mrk.json", SkeletonFormat::kMarkups},
                                              {".vtp", SkeletonFormat::kVtp},
                                              {".graphml", SkeletonFormat::kGraphMl},
                                              {".obj", SkeletonFormat::kObj},
                                              {".json", SkeletonFormat::kJson},
                                              {".csv", SkeletonFormat::kCsv},
                                              {".glb", SkeletonFormat::kGlb},
                                              {".exr", SkeletonFormat::kVolume},
                                              {".bccb", SkeletonFormat::kVolume},
                                              {".svg", SkeletonFormat::kSvg},
                                              {".png", SkeletonFormat::kPng},
                                              {".html", SkeletonFormat::kHtml},
                                              {".precomputed", SkeletonFormat::kPrecomputed}}};

// A billion lengths of this size have a finite sum.
constexpr double kModerate = 1e150;

// The largest absolute value of the point's numbers; infinity if one is not finite.
double LargestOf(const SkeletonGraph& graph, const SkeletonPoint& point) {
  const WorldPoint p = graph.PositionOf(point);
  double largest = 0;
  for (const double number : {p[0], p[1], p[2], graph.RadiusOf(point)}) {
    if (!std::isfinite(number)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(number));
  }
  return largest;
}

// Text formats cannot hold infinities.
absl::Status CheckFinite(const SkeletonGraph& graph) {
  double largest = std::ranges::max(graph.placement.spacing);
  const auto add = [&](const SkeletonPoint& p) {
    largest = std::max(largest, LargestOf(graph, p));
  };
  std::ranges::for_each(graph.points, add);
  std::ranges::for_each(graph.sheets, add);
  std::ranges::for_each(graph.nodes, add, &SkeletonNode::at);
  if (largest < kModerate) return absl::OkStatus();
  const bool lengths = std::ranges::all_of(graph.edges, [&](const SkeletonEdge& edge) {
    return std::isfinite(FiguresOf(graph, edge).length);
  });
  return std::isfinite(largest) && lengths
             ? absl::OkStatus()
             : absl::InvalidArgumentError("the skeleton's coordinates do not fit a double");
}

absl::StatusOr<Document> WithoutNote(absl::StatusOr<std::string> bytes) {
  if (!bytes.ok()) return std::move(bytes).status();
  return Document{*std::move(bytes), ""};
}

std::string JsonText(const Subject& subject, JsonParts parts = JsonParts::kAll) {
  const exec::Context& context = subject.context;
  return exporting::JsonText(subject.result,
                             OrderOf(subject.result.graph, subject.root, context.stop),
                             subject.world, parts, context);
}

absl::StatusOr<view::Peeling> PeelingOf(const Subject& subject) {
  if (subject.labels.has_value()) return view::Peeling{{{0, subject.labels->surfaces}}, 0};
  if (subject.shells == nullptr) return view::PeelForDisplay(subject.object, {}, subject.context);
  return view::PeelByShells(subject.object, *subject.shells, subject.result.last_shell, {},
                            subject.context);
}

absl::StatusOr<std::string> SvgText(const Subject& subject) {
  BCCSKEL_ASSIGN_OR_RETURN(const view::ResultDocument result, DocumentOf(subject));
  return SvgText(subject, result);
}

absl::StatusOr<std::string> PageText(const Subject& subject) {
  BCCSKEL_ASSIGN_OR_RETURN(view::ResultDocument result, DocumentOf(subject));
  result.text = std::make_shared<const std::string>(JsonText(subject, JsonParts::kForPage));
  BCCSKEL_ASSIGN_OR_RETURN(const view::Peeling peeling, PeelingOf(subject));
  return view::PageOf({subject.title, result, peeling}, subject.context);
}

// nullopt for a format that needs more than a graph.
std::optional<absl::StatusOr<Document>> ComposeGraph(SkeletonFormat format,
                                                     const GraphSubject& subject) {
  const auto& [graph, context, world, sampling] = subject;
  switch (format) {
    case SkeletonFormat::kSwc:
      return WriteSwc(graph, context.order, {sampling, context.facts, context.exec.stop});
    case SkeletonFormat::kVtp:
      return WithoutNote(VtpText(graph, context));
    case SkeletonFormat::kGraphMl:
      return WithoutNote(GraphMlText(graph, context));
    case SkeletonFormat::kObj:
      return WithoutNote(ObjText(graph, context));
    case SkeletonFormat::kCsv:
      return WithoutNote(BranchTableText(graph, context));
    case SkeletonFormat::kMarkups:
      return WriteMarkups(graph, context, world);
    case SkeletonFormat::kGlb:
      return WriteGlb(graph, context, world);
    default:
      return std::nullopt;
  }
}

// Needs: JSON, or a format that shows the object.
absl::StatusOr<std::string> Compose(const std::string& path, SkeletonFormat format,
                                    const Subject& subject) {
  if (format == SkeletonFormat::kSvg) return SvgText(subject);
  if (format == SkeletonFormat::kHtml) return PageText(subject);
  if (format == SkeletonFormat::kJson) return JsonText(subject);
  if (subject.draw != nullptr) return subject.draw(subject);
  return absl::UnimplementedError(path + ": this program draws no pictures; write an .svg, or " +
                                  "draw a .json file with `bccskel render`");
}

absl::StatusOr<std::string> WriteDocument(const std::string& path,
                                          const absl::StatusOr<Document>& document,
                                          const std::stop_token& stop) {
  BCCSKEL_RETURN_IF_ERROR(document.status());
  BCCSKEL_RETURN_IF_ERROR(WriteFileAtomically(path, document->text, stop));
  return document->note;
}

}  // namespace

absl::StatusOr<SkeletonFormat> SkeletonFormatOf(const std::string& path) {
  std::string lower = absl::AsciiStrToLower(path);
  if (lower.ends_with(".precomputed/")) lower.pop_back();
  for (const Ending& ending : kEndings) {
    if (lower.ends_with(ending.text)) return ending.format;
  }
  const bool has_ending = path.find('.', path.rfind('/') + 1) != path.npos;
  const char* problem = has_ending ? "no output format has this ending; there are "
                                   : "an output needs an ending, which selects its format: ";
  return absl::InvalidArgumentError(
      absl::StrCat(path.empty() ? "an empty name" : path, ": ", problem, SkeletonFormatEndings()));
}

bool ShowsObject(SkeletonFormat format) {
  return format == SkeletonFormat::kSvg || format == SkeletonFormat::kPng ||
         format == SkeletonFormat::kHtml;
}

bool ShowsObject(const std::string& path) {
  const absl::StatusOr<SkeletonFormat> format = SkeletonFormatOf(path);
  return format.ok() && ShowsObject(*format);
}

std::string SkeletonFormatEndings() {
  std::string endings;
  for (const Ending& ending : kEndings) {
    if (!endings.empty()) endings += ", ";
    endings += ending.text;
  }
  return endings;
}

bool HoldsGraph(const std::string& path) {
  const absl::StatusOr<SkeletonFormat> format = SkeletonFormatOf(path);
  return format.ok() && *format != SkeletonFormat::kJson && *format != SkeletonFormat::kVolume &&
         !ShowsObject(*format);
}

absl::Status CheckOutput(const std::string& path) {
  const absl::StatusOr<SkeletonFormat> format = SkeletonFormatOf(path);
  const bool folder = format.ok() && *format == SkeletonFormat::kPrecomputed;
  return folder ? CheckPrecomputedFolder(path) : CheckWritable(path);
}

absl::StatusOr<std::string> WriteSkeletonFile(const std::string& path, const Subject& subject) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, SkeletonFormatOf(path));
  if (format == SkeletonFormat::kVolume) {
    BCCSKEL_RETURN_IF_ERROR(WriteVolumeFile(path, subject.result.thin, subject.context));
    return std::string();
  }
  const SkeletonGraph& graph = subject.result.graph;
  const std::stop_token& stop = subject.context.stop;
  if (format == SkeletonFormat::kJson || ShowsObject(format)) {
    BCCSKEL_RETURN_IF_ERROR(CheckFinite(graph));
    return WriteDocument(path, WithoutNote(Compose(path, format, subject)), stop);
  }
  return WriteGraphFile(path, {.graph = graph,
                               .context = {.labels = {},
                                           .facts = MethodFactsOf(subject.result, subject.world),
                                           .order = OrderOf(graph, subject.root, stop),
                                           .exec = subject.context},
                               .world = subject.world,
                               .swc = subject.swc});
}

absl::StatusOr<std::string> WriteGraphFile(const std::string& path, const GraphSubject& subject) {
  const std::stop_token& stop = subject.context.exec.stop;
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, SkeletonFormatOf(path));
  BCCSKEL_RETURN_IF_ERROR(CheckFinite(subject.graph));
  if (format == SkeletonFormat::kPrecomputed) {
    return WritePrecomputed(
        path, subject.graph,
        {.labels = subject.context.labels, .world = subject.world, .sampling = subject.swc}, stop);
  }
  const auto document = ComposeGraph(format, subject);
  if (document.has_value()) return WriteDocument(path, *document, stop);
  return absl::InvalidArgumentError(path +
                                    ": this format needs more than the graph of a result; write it "
                                    "with skeletonize, or with view and render");
}

}  // namespace bccskel::exporting
