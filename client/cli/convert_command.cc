#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/summaries.h"
#include "client/cli/thinning_options.h"
#include "client/export/method_facts.h"
#include "client/export/skeleton_file.h"
#include "client/export/text.h"
#include "client/view/result_graph.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

std::string Known(const std::string& text) { return text == "unknown" ? "" : text; }

std::string SummaryOf(const ConvertArguments& arguments, const std::vector<std::string>& notes) {
  exporting::Text text;
  const bool json = arguments.common.summary == SummaryStyle::kJson;
  if (json) text.Add("{\"result\":", JsonString(arguments.result), ",\"outputs\":[");
  for (size_t n = 0; n < notes.size(); ++n) {
    const std::string& path = arguments.outputs[n];
    if (json) {
      text.Add(n == 0 ? "" : ",", "{\"path\":", JsonString(path),
               ",\"note\":", JsonString(notes[n]), '}');
    } else {
      text.Add("written:   ", path, notes[n].empty() ? "" : ", ", notes[n], '\n');
    }
  }
  if (json) text.Add("]}\n");
  return std::move(text).Take();
}

absl::StatusOr<std::vector<std::string>> WriteAll(const ConvertArguments& arguments,
                                                  const exporting::GraphSubject& subject,
                                                  const std::stop_token& stop) {
  std::vector<std::string> notes;
  for (const std::string& path : arguments.outputs) {
    BCCSKEL_ASSIGN_OR_RETURN(notes.emplace_back(), exporting::WriteGraphFile(path, subject, stop));
  }
  return notes;
}

}  // namespace

void AddConvert(CLI::App& command, ConvertArguments& arguments) {
  AddResult(command, arguments.result);
  command
      .add_option("-o,--output", arguments.outputs,
                  "Output file: .swc, .vtp, .graphml, .obj, .csv, .mrk.json, .glb or .precomputed; "
                  "may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->check([](const std::string& path) {
        const bool fits = exporting::HoldsGraph(path);
        return fits ? ""
                    : path +
                          ": convert writes .swc, .vtp, .graphml, .obj, .csv, .mrk.json, "
                          ".glb and .precomputed; view and render make pictures";
      })
      ->option_text("FILE (required)");
  AddRoot(command, arguments.root);
  AddSwcStep(command, arguments.swc);
  AddJson(command, arguments.common);
}

ExitCode Run(const ConvertArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<view::ResultGraph> result = view::ReadResultGraph(arguments.result);
  if (!result.ok()) return Fail(result.status());
  std::optional<TreeOrder> order;
  if (arguments.root.has_value()) {
    const absl::Status fits = CheckRootChoice(*arguments.root, result->graph);
    if (!fits.ok()) return FailWith(ExitCode::kUsage, fits);
    order = OrderTrees(result->graph, *arguments.root);
  }
  const auto notes = WriteAll(arguments,
                              {.graph = result->graph,
                               .context = {.labels = {},
                                           .facts = exporting::MethodFactsOf(*result),
                                           .order = std::move(order)},
                               .world = {Known(result->world), Known(result->unit)},
                               .swc = arguments.swc},
                              stop);
  if (!notes.ok()) return FailWith(ExitCode::kOutput, notes.status());
  return Print(SummaryOf(arguments, *notes));
}

}  // namespace bccskel::cli
