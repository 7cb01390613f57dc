#include <utility>

#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/json_text.h"
#include "client/cli/load_object.h"
#include "client/cli/local_team.h"
#include "client/cli/result_object.h"
#include "client/export/atomic_file.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "client/view/page.h"

namespace bccskel::cli {
namespace {

std::string SummaryOf(const ViewArguments& arguments, const view::Peeling& peeling, size_t bytes) {
  const size_t triangles = peeling.layers.front().surface.triangles.size();
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"result\":", JsonString(arguments.source.result),
             ",\"object\":", JsonString(arguments.source.object),
             ",\"output\":", JsonString(arguments.output), ",\"triangles\":", triangles,
             ",\"layers\":", peeling.layers.size(), ",\"bytes\":", bytes, "}\n");
  } else {
    text.Add("surface:     ", exporting::GroupedDigits(triangles), " triangles, ",
             peeling.layers.size(), " layers of ", peeling.last_shell,
             " shells\nwritten:     ", arguments.output, ", ", exporting::GroupedDigits(bytes),
             " bytes\n");
  }
  return std::move(text).Take();
}

}  // namespace

ExitCode Run(const ViewArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<ResultAndObject> loaded =
      LoadResultAndObject(arguments.source, team.context());
  if (!loaded.ok()) return Fail(loaded.status());
  const absl::StatusOr<view::Peeling> peeling =
      view::PeelForDisplay(loaded->object, {}, team.context());
  if (!peeling.ok()) return Fail(peeling.status());
  const std::string title(FileName(arguments.source.object));
  const absl::StatusOr<std::string> page = view::PageOf({title, loaded->result, *peeling});
  if (!page.ok()) return Fail(page.status());
  const absl::Status written = exporting::WriteFileAtomically(arguments.output, *page);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, *peeling, page->size()));
}

}  // namespace bccskel::cli
