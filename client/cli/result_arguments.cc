#include "client/cli/result_arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "absl/strings/str_join.h"
#include "client/cli/root_argument.h"
#include "client/cli/swc_argument.h"
#include "client/export/skeleton_file.h"

namespace bccskel::cli {
namespace {

void AddOutput(CLI::App& command, std::string& path, const char* what,
               const std::vector<std::string>& endings) {
  const std::string choice = absl::StrJoin(endings, " or ");
  command.add_option("-o,--output", path, std::string(what) + " to write: " + choice)
      ->required()
      ->check([endings, choice](const std::string& given) {
        const auto fits = [&](const std::string& ending) { return given.ends_with(ending); };
        return std::ranges::any_of(endings, fits) ? "" : given + ": does not end in " + choice;
      })
      ->option_text("FILE (required)");
}

CLI::Option& AddSource(CLI::App& command, ResultArguments& source) {
  command.add_option("RESULT", source.result, "JSON file of skeletonize or submit")
      ->required()
      ->option_text(" ");
  return *command
              .add_option("--object", source.object,
                          "Mesh, volume or image that the result was made from")
              ->option_text("FILE");
}

void AddSourceWithObject(CLI::App& command, ResultArguments& source) {
  AddSource(command, source).required()->option_text("FILE (required)");
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
          "Pixels of the picture (default 1200x900)")
      ->option_text("WIDTHxHEIGHT");
  command
      .add_option("--turn", picture.turn,
                  "Walk around the object to the right, from its broadest side (default 30)")
      ->option_text("DEGREES");
  command.add_option("--climb", picture.climb, "Look from above (default 15)")
      ->option_text("DEGREES");
}

}  // namespace

void AddView(CLI::App& command, ViewArguments& arguments) {
  AddSource(command, arguments.source);
  AddOutput(command, arguments.output, "Page", {".html"});
}

void AddRender(CLI::App& command, RenderArguments& arguments) {
  AddSourceWithObject(command, arguments.source);
  AddOutput(command, arguments.output, "Picture", {".png"});
  AddPicture(command, arguments.picture);
}

void AddConvert(CLI::App& command, ConvertArguments& arguments) {
  command.add_option("RESULT", arguments.result, "JSON file of skeletonize or submit")
      ->required()
      ->option_text(" ");
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
}

void AddReconstruct(CLI::App& command, ReconstructArguments& arguments) {
  AddSourceWithObject(command, arguments.source);
  AddOutput(command, arguments.output, "Volume", {".exr", ".bccb"});
}

}  // namespace bccskel::cli
