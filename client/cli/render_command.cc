#include <tuple>
#include <utility>

#include "absl/strings/match.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/option_values.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/export/atomic_file.h"
#include "client/export/picture/caption.h"
#include "client/export/picture/svg.h"
#include "client/export/text.h"
#include "client/view/display_surface.h"

namespace bccskel::cli {
namespace {

constexpr std::pair kSvgSize = {exporting::kSvgWidth, exporting::kSvgHeight};

bool IsSvg(const RenderArguments& arguments) {
  return absl::EndsWithIgnoreCase(arguments.output, ".svg");
}

std::string SummaryOf(const RenderArguments& arguments, size_t triangles) {
  view::PictureOptions picture = arguments.picture;
  if (IsSvg(arguments)) std::tie(picture.width, picture.height) = kSvgSize;
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add(FilesJson(arguments), ",\"triangles\":", triangles, ",\"width\":", picture.width,
             ",\"height\":", picture.height, "}\n");
  } else {
    if (!arguments.object.empty()) {
      text.Add("surface:     ", exporting::GroupedDigits(triangles), " triangles\n");
    }
    text.Add("written:     ", arguments.output, ", ", picture.width, " x ", picture.height,
             " pixels\n");
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
          "Size in pixels (default 1200x900); .svg files have one size and three views")
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

// Empty without an object.
absl::StatusOr<view::DisplaySurface> SurfaceOf(const RenderArguments& arguments,
                                               const std::optional<Volume>& object,
                                               const ProgressBar& bar,
                                               const exec::Context& context) {
  if (!object.has_value()) return view::DisplaySurface();
  bar.Begin("making the surface");
  const size_t most = IsSvg(arguments) ? exporting::kMostSvgTriangles : view::kMostPictureTriangles;
  return view::MakeDisplaySurface(*object, most, context);
}

absl::StatusOr<std::string> Draw(const RenderArguments& arguments, const ResultAndObject& loaded,
                                 const view::DisplaySurface& surface,
                                 const exec::Context& context) {
  if (IsSvg(arguments)) {
    return exporting::SvgText(
        {.title = loaded.title, .result = loaded.result, .surface = surface, .context = context});
  }
  view::PictureOptions options = arguments.picture;
  options.title = loaded.title;
  return view::RenderPng(loaded.result, surface, options, context);
}

bool AsksForAView(const view::PictureOptions& picture) {
  const view::PictureOptions none;
  return picture.turn.has_value() || picture.climb.has_value() || picture.width != none.width ||
         picture.height != none.height;
}

}  // namespace

void AddRender(CLI::App& command, RenderArguments& arguments) {
  AddResultAndObject(command, arguments, ObjectNeed::kOptional);
  AddOutput(command, arguments.output, "Picture", {".png", ".svg"});
  AddPicture(command, arguments.picture);
}

ExitCode Run(const RenderArguments& arguments, const std::stop_token& stop) {
  if (IsSvg(arguments) && AsksForAView(arguments.picture)) {
    return FailWith(ExitCode::kUsage,
                    absl::InvalidArgumentError("--size, --turn and --climb are for .png; an .svg "
                                               "has one size and three views"));
  }
  LocalTeam team(arguments.common.threads, stop);
  const ProgressBar bar(arguments.common.progress);
  const absl::StatusOr<ResultAndObject> loaded =
      LoadResultAndObject(arguments, bar, team.context());
  if (!loaded.ok()) return Fail(loaded.status());
  const auto surface = SurfaceOf(arguments, loaded->object, bar, team.context());
  if (!surface.ok()) return Fail(surface.status());
  bar.Begin("writing", arguments.output);
  const absl::StatusOr<std::string> picture = Draw(arguments, *loaded, *surface, team.context());
  if (!picture.ok()) return Fail(picture.status());
  const absl::Status written = exporting::WriteFileAtomically(arguments.output, *picture, stop);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, surface->triangles.size()));
}

}  // namespace bccskel::cli
