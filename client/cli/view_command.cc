#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/export/atomic_file.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "client/view/page.h"

namespace bccskel::cli {
namespace {

std::string SummaryOf(const ViewArguments& arguments, const view::Peeling& peeling, size_t bytes) {
  const size_t triangles =
      peeling.layers.empty() ? 0 : peeling.layers.front().surface.triangles.size();
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add(FilesJson(arguments), ",\"triangles\":", triangles,
             ",\"layers\":", peeling.layers.size(), ",\"bytes\":", bytes, "}\n");
  } else {
    if (!peeling.layers.empty()) {
      text.Add("surface:     ", exporting::Counted(triangles, "triangle", "triangles"),
               ", the object and ",
               exporting::Counted(peeling.layers.size() - 1, "layer", "layers"), " below it, of ",
               exporting::Counted(static_cast<uint64_t>(peeling.last_shell), "shell", "shells"),
               '\n');
    }
    text.Add("written:     ", arguments.output, ", ", exporting::GroupedDigits(bytes), " bytes\n");
  }
  return std::move(text).Take();
}

// Without layers if no object is given.
absl::StatusOr<view::Peeling> Peel(const ResultAndObject& loaded, const ProgressBar& bar,
                                   const exec::Context& context) {
  if (!loaded.object.has_value()) return view::Peeling();
  bar.Begin("peeling the object for the page");
  return view::PeelForDisplay(*loaded.object, {}, context);
}

}  // namespace

void AddView(CLI::App& command, ViewArguments& arguments) {
  AddResultAndObject(command, arguments, ObjectNeed::kOptional);
  AddOutput(command, arguments.output, "Page", {".html"});
}

ExitCode Run(const ViewArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const ProgressBar bar(arguments.common.progress);
  const absl::StatusOr<ResultAndObject> loaded =
      LoadResultAndObject(arguments, bar, team.context());
  if (!loaded.ok()) return Fail(loaded.status());
  const absl::StatusOr<view::Peeling> peeling = Peel(*loaded, bar, team.context());
  if (!peeling.ok()) return Fail(peeling.status());
  bar.Begin("writing", arguments.output);
  const absl::StatusOr<std::string> page =
      view::PageOf({loaded->title, loaded->result, *peeling}, team.context());
  if (!page.ok()) return Fail(page.status());
  const absl::Status written = exporting::WriteFileAtomically(arguments.output, *page, stop);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, *peeling, page->size()));
}

}  // namespace bccskel::cli
