#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/option_values.h"
#include "client/cli/summaries.h"
#include "client/export/atomic_file.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "client/view/display_surface.h"

namespace bccskel::cli {
namespace {

std::string SummaryOf(const RenderArguments& arguments, size_t triangles) {
  const view::PictureOptions& picture = arguments.picture;
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add(FilesJson(arguments), ",\"triangles\":", triangles, ",\"width\":", picture.width,
             ",\"height\":", picture.height, "}\n");
  } else {
    text.Add("surface:     ", exporting::GroupedDigits(triangles),
             " triangles\nwritten:     ", arguments.output, ", ", picture.width, " x ",
             picture.height, " pixels\n");
  }
  return std::move(text).Take();
}

void ReadSize(const std::string& text, view::PictureOptions& picture) {
  int end = 0;
  const int read = std::sscanf(text.c_str(), "%5dx%5d%n", &picture.width, &picture.height, &end);
  const auto [low, high] = std::minmax(picture.width, picture.height);
  if (read == 2 && text.size() == static_cast<size_t>(end) && low >= view::kMinPictureSide &&
      high <= view::kMaxPictureSide) {
    return;
  }
  throw CLI::ValidationError("--size " + text + ": must be like 1200x900, each number within " +
                             std::to_string(view::kMinPictureSide) + " and " +
                             std::to_string(view::kMaxPictureSide));
}

void AddPicture(CLI::App& command, view::PictureOptions& picture) {
  command
      .add_option_function<std::string>(
          "--size", [&picture](const std::string& text) { ReadSize(text, picture); },
          "Size in pixels (default 1200x900)")
      ->option_text("WIDTHxHEIGHT");
  command
      .add_option("--turn", picture.turn,
                  "Rotate the view to the right, starting in front of the broadest side (default "
                  "30; for one slice 0)")
      ->check(Within(-360, 360))
      ->option_text("DEGREES");
  command
      .add_option("--climb", picture.climb,
                  "Raise the view above the object (default 15; for one slice 0)")
      ->check(Within(-360, 360))
      ->option_text("DEGREES");
}

}  // namespace

void AddRender(CLI::App& command, RenderArguments& arguments) {
  AddResultAndObject(command, arguments, ObjectNeed::kRequired);
  AddOutput(command, arguments.output, "Picture", {".png"});
  AddPicture(command, arguments.picture);
}

ExitCode Run(const RenderArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<ResultAndObject> loaded = LoadResultAndObject(arguments, team.context());
  if (!loaded.ok()) return Fail(loaded.status());
  const absl::StatusOr<view::DisplaySurface> surface =
      view::MakeDisplaySurface(loaded->object, view::kMostPictureTriangles, team.context());
  if (!surface.ok()) return Fail(surface.status());
  view::PictureOptions options = arguments.picture;
  options.title = FileName(arguments.object);
  const absl::StatusOr<std::string> png =
      view::RenderPng(loaded->result, *surface, options, team.context());
  if (!png.ok()) return Fail(png.status());
  const absl::Status written = exporting::WriteFileAtomically(arguments.output, *png, stop);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, surface->triangles.size()));
}

}  // namespace bccskel::cli
