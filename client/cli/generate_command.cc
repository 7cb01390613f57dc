#include <CLI/CLI.hpp>
#include <string>
#include <utility>

#include "absl/strings/str_join.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/option_values.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/export/text.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

std::string ShapeNames() {
  return absl::StrJoin(kShapes, ", ",
                       [](std::string* out, Shape shape) { *out += ShapeName(shape); });
}

}  // namespace

void AddGenerate(CLI::App& command, GenerateArguments& arguments) {
  command
      .add_option_function<std::string>(
          "SHAPE",
          [&arguments](const std::string& name) {
            const absl::StatusOr<Shape> shape = ParseShapeName(name);
            if (!shape.ok()) throw CLI::ValidationError(std::string(shape.status().message()));
            arguments.shape = *shape;
          },
          "One of " + ShapeNames())
      ->required()
      ->option_text(" ");
  AddOutput(command, arguments.output, "Volume", {".exr", ".bccb"});
  AddCount(command, "--points", arguments.options.points,
           "Number of points of the object (default 850000)", kMinShapePoints, kMaxShapePoints);
  AddCount(command, "--seed", arguments.options.seed, "Seed of the random parts (default 0)");
  command
      .add_option("--noise", arguments.options.noise,
                  "Fraction of boundary points that change sides, 0 to 0.1 (default 0)")
      ->option_text("X");
  AddProgress(command, arguments.common.progress);
  AddJson(command, arguments.common);
}

namespace {

std::string SummaryOf(const GenerateArguments& arguments, const Volume& volume) {
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"shape\":\"", ShapeName(arguments.shape),
             "\",\"output\":", JsonString(arguments.output),
             ",\"volume\":", VolumeJson(volume, std::nullopt), "}\n");
  } else {
    text.Add("shape:       ", ShapeName(arguments.shape), '\n', VolumeText(volume, std::nullopt),
             "written:     ", arguments.output, '\n');
  }
  return std::move(text).Take();
}

}  // namespace

ExitCode Run(const GenerateArguments& arguments, const std::stop_token& stop) {
  const ProgressBar bar(arguments.common.progress);
  bar.Begin("making the shape");
  const absl::StatusOr<Volume> volume = GenerateShape(arguments.shape, arguments.options);
  if (!volume.ok()) return FailWith(ExitCode::kUsage, volume.status());
  exec::Context context;
  context.stop = stop;
  bar.Begin("writing", arguments.output);
  const absl::Status written = WriteVolumeFile(arguments.output, *volume, context);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, *volume));
}

}  // namespace bccskel::cli
