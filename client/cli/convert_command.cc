#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/summaries.h"
#include "client/cli/thinning_options.h"
#include "client/export/method_facts.h"
#include "client/export/skeleton_file.h"
#include "client/view/result_graph.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

std::string Known(const std::string& text) { return text == "unknown" ? "" : text; }

std::string SummaryOf(const ConvertArguments& arguments, const std::vector<WrittenFile>& files) {
  if (arguments.common.summary == SummaryStyle::kText) return FilesText(files);
  return "{\"result\":" + JsonString(arguments.result) + ",\"outputs\":" + FilesJson(files) + "}\n";
}

absl::StatusOr<std::vector<WrittenFile>> WriteAll(const ConvertArguments& arguments,
                                                  const exporting::GraphSubject& subject,
                                                  const std::stop_token& stop) {
  std::vector<WrittenFile> files;
  for (const std::string& path : arguments.outputs) {
    BCCSKEL_ASSIGN_OR_RETURN(std::string note, exporting::WriteGraphFile(path, subject, stop));
    files.push_back({path, std::move(note)});
  }
  return files;
}

}  // namespace

void AddConvert(CLI::App& command, ConvertArguments& arguments) {
  AddResult(command, arguments.result);
  AddOutputs(command, arguments.outputs,
             ".swc, .vtp, .graphml, .obj, .csv, .mrk.json, .glb or .precomputed")
      ->check([](const std::string& path) {
        const bool fits = exporting::HoldsGraph(path);
        return fits ? ""
                    : path +
                          ": convert writes .swc, .vtp, .graphml, .obj, .csv, .mrk.json, "
                          ".glb and .precomputed; view and render make pictures";
      });
  AddRoot(command, arguments.root);
  AddSwcStep(command, arguments.swc);
  AddJson(command, arguments.common);
}

ExitCode Run(const ConvertArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<view::ResultGraph> result = view::ReadResultGraph(arguments.result);
  if (!result.ok()) return Fail(result.status());
  const std::optional<RootChoice>& root =
      arguments.root.has_value() ? arguments.root : result->root;
  std::optional<TreeOrder> order;
  if (root.has_value()) {
    const absl::Status fits = CheckRootChoice(*root, result->graph);
    if (!fits.ok()) return FailWith(ExitCode::kUsage, fits);
    const std::string outside = RootWarning(*root, result->graph);
    if (!outside.empty()) Warn(arguments.result + ": " + outside);
    order = OrderTrees(result->graph, *root);
  }
  const auto files = WriteAll(arguments,
                              {.graph = result->graph,
                               .context = {.labels = {},
                                           .facts = exporting::MethodFactsOf(*result),
                                           .order = std::move(order)},
                               .world = {Known(result->world), Known(result->unit)},
                               .swc = arguments.swc},
                              stop);
  if (!files.ok()) return FailWith(ExitCode::kOutput, files.status());
  return Print(SummaryOf(arguments, *files));
}

}  // namespace bccskel::cli
