#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/cli/thinning_options.h"
#include "client/export/atomic_file.h"
#include "client/export/method_facts.h"
#include "client/export/skeleton_file.h"
#include "client/view/render/subject_picture.h"
#include "client/view/result_graph.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

std::string Known(const std::string& text) { return text == "unknown" ? "" : text; }

std::string SummaryOf(const ConvertArguments& arguments, const std::vector<WrittenFile>& files) {
  if (arguments.common.summary == SummaryStyle::kText) return FilesText(files);
  return "{\"result\":" + JsonString(arguments.result) + ",\"outputs\":" + FilesJson(files) + "}\n";
}

// Whether ComposeDocument() makes the file.
bool HoldsDocument(const std::string& path) {
  const absl::StatusOr<exporting::SkeletonFormat> format = exporting::SkeletonFormatOf(path);
  return format.ok() &&
         (*format == exporting::SkeletonFormat::kJson || exporting::ShowsObject(*format));
}

absl::Status WriteDocument(const std::string& path, const std::string& title,
                           const view::ResultDocument& result, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const exporting::SkeletonFormat format,
                           exporting::SkeletonFormatOf(path));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string text,
                           view::ComposeDocument(format, title, result, context));
  return exporting::WriteFileAtomically(path, text, context.stop);
}

ExitCode WriteDocuments(const ConvertArguments& arguments, const view::ResultDocument& result,
                        const ProgressBar& bar, const exec::Context& context,
                        const std::vector<WrittenFile>& files) {
  const std::string title(FileName(arguments.result));
  for (const WrittenFile& file : files) {
    if (!HoldsDocument(file.path)) continue;
    bar.Begin("writing", file.path);
    const absl::Status written = WriteDocument(file.path, title, result, context);
    if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  }
  return ExitCode::kOk;
}

ExitCode WriteGraphs(const ConvertArguments& arguments, const view::ResultDocument& document,
                     const ProgressBar& bar, const exec::Context& context,
                     std::vector<WrittenFile>& files) {
  if (std::ranges::none_of(arguments.outputs, exporting::HoldsGraph)) return ExitCode::kOk;
  absl::StatusOr<view::ResultGraph> result = view::ResultGraphOf(document, context.stop);
  if (!result.ok()) return Fail(WithPath(result.status(), arguments.result));
  result->unit = arguments.unit.value_or(result->unit);
  const std::optional<RootChoice>& root =
      arguments.root.has_value() ? arguments.root : result->root;
  std::optional<TreeOrder> order;
  if (root.has_value()) {
    const absl::Status fits = CheckRootChoice(*root, result->graph);
    if (!fits.ok()) return FailWith(ExitCode::kUsage, fits);
    const std::string outside = RootWarning(*root, result->graph);
    if (!outside.empty()) Warn(arguments.result + ": " + outside);
    order = OrderTrees(result->graph, *root, context.stop);
  }
  const exporting::GraphSubject subject = {.graph = result->graph,
                                           .context = {.labels = {},
                                                       .facts = exporting::MethodFactsOf(*result),
                                                       .order = std::move(order),
                                                       .exec = context},
                                           .world = {Known(result->world), Known(result->unit)},
                                           .swc = arguments.swc};
  for (WrittenFile& file : files) {
    if (!exporting::HoldsGraph(file.path)) continue;
    bar.Begin("writing", file.path);
    absl::StatusOr<std::string> note = exporting::WriteGraphFile(file.path, subject);
    if (!note.ok()) return FailWith(ExitCode::kOutput, note.status());
    file.note = *std::move(note);
  }
  return ExitCode::kOk;
}

}  // namespace

void AddConvert(CLI::App& command, ConvertArguments& arguments) {
  AddResult(command, arguments.result);
  AddOutputs(command, arguments.outputs,
             ".json, .swc, .vtp, .graphml, .obj, .csv, .mrk.json, .glb, .precomputed, or a picture "
             "of the curves alone: .svg, .png or .html")
      ->check([](const std::string& path) {
        const bool fits = exporting::HoldsGraph(path) || HoldsDocument(path);
        return fits ? ""
                    : path +
                          ": convert writes .json, .swc, .vtp, .graphml, .obj, .csv, .mrk.json, "
                          ".glb, .precomputed, .svg, .png and .html; reconstruct makes volumes";
      });
  AddRoot(command, arguments.root);
  AddSwcStep(command, arguments.swc);
  AddUnit(command, arguments.unit, "Unit of lengths, such as um, instead of that of the result");
  AddProgress(command, arguments.common.progress);
  AddJson(command, arguments.common);
}

ExitCode Run(const ConvertArguments& arguments, const std::stop_token& stop) {
  const bool changes = arguments.root.has_value() || arguments.unit.has_value();
  if (changes && std::ranges::any_of(arguments.outputs, HoldsDocument)) {
    return FailWith(ExitCode::kUsage, absl::InvalidArgumentError(
                                          "--root and --unit are for the other formats; .json, "
                                          ".svg, .png and .html show the result as it is"));
  }
  const ProgressBar bar(arguments.common.progress);
  bar.Begin("reading", arguments.result);
  const absl::StatusOr<view::ResultDocument> document =
      view::ReadResultDocument(arguments.result, stop);
  if (!document.ok()) return Fail(document.status());
  std::vector<WrittenFile> files;
  for (const std::string& path : arguments.outputs) files.push_back({path, ""});
  LocalTeam team(arguments.common.threads, stop);
  ExitCode code = WriteGraphs(arguments, *document, bar, team.context(), files);
  if (code == ExitCode::kOk) {
    code = WriteDocuments(arguments, *document, bar, team.context(), files);
  }
  if (code != ExitCode::kOk) return code;
  return Print(SummaryOf(arguments, files));
}

}  // namespace bccskel::cli
