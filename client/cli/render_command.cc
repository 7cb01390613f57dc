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
#include "client/view/display_surface.h"

namespace bccskel::cli {
namespace {

// Fine enough for a print.
constexpr size_t kMostTriangles = 1'000'000;

std::string SummaryOf(const RenderArguments& arguments, size_t triangles) {
  const view::PictureOptions& picture = arguments.picture;
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"result\":", JsonString(arguments.source.result),
             ",\"object\":", JsonString(arguments.source.object),
             ",\"output\":", JsonString(arguments.output), ",\"triangles\":", triangles,
             ",\"width\":", picture.width, ",\"height\":", picture.height, "}\n");
  } else {
    text.Add("surface:     ", exporting::GroupedDigits(triangles),
             " triangles\nwritten:     ", arguments.output, ", ", picture.width, " x ",
             picture.height, " pixels\n");
  }
  return std::move(text).Take();
}

}  // namespace

ExitCode Run(const RenderArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<ResultAndObject> loaded =
      LoadResultAndObject(arguments.source, team.context());
  if (!loaded.ok()) return Fail(loaded.status());
  const absl::StatusOr<view::DisplaySurface> surface =
      view::MakeDisplaySurface(loaded->object, kMostTriangles, team.context());
  if (!surface.ok()) return Fail(surface.status());
  view::PictureOptions options = arguments.picture;
  options.title = FileName(arguments.source.object);
  const absl::StatusOr<std::string> png =
      view::RenderPng(loaded->result, *surface, options, team.context());
  if (!png.ok()) return Fail(png.status());
  const absl::Status written = exporting::WriteFileAtomically(arguments.output, *png, stop);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, surface->triangles.size()));
}

}  // namespace bccskel::cli
