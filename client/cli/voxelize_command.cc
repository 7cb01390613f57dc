#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

// The facts about the input, as text and as members of a JSON object.
struct Story {
  std::string text;
  std::string json;
};

struct Voxelized {
  Volume volume;
  Story source;
};

Story MeshStory(const MeshStage& stage) {
  std::string text = "mesh:        " + MeshPhrase(stage.mesh) +
                     "\nfilled by:   " + FillRuleName(stage.fill) + '\n';
  if (stage.added_points > 0) text += "thin parts:  " + ThinPartsPhrase(stage) + '\n';
  return {std::move(text), MeshStageJson(stage)};
}

Story ImageStory(const ImageStage& image) {
  return {"image:       " + ImagePhrase(image) +
              "\nmask:        " + exporting::BettiPhrase(image.mask) + '\n',
          "\"image\":" + ImageJson(image)};
}

absl::StatusOr<Voxelized> FromMesh(const VoxelizeArguments& arguments,
                                   const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(VoxelizeResult result,
                           VoxelizeFile(arguments.input, arguments.grid, context));
  for (const std::string& warning : result.warnings) Warn(arguments.input + ": " + warning);
  return Voxelized{std::move(result.volume), MeshStory(MeshStageOf(result))};
}

absl::StatusOr<Voxelized> FromImage(const VoxelizeArguments& arguments,
                                    const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(ImageObject object, ConvertImageFile(arguments.input, arguments.image,
                                                                KeptVoxels::kNone, context));
  BCCSKEL_ASSIGN_OR_RETURN(const BettiNumbers betti, CountBettiNumbers(object.volume, context));
  BCCSKEL_RETURN_IF_ERROR(
      CheckConversion(arguments.input, arguments.image, object.image.mask, betti));
  return Voxelized{std::move(object.volume), ImageStory(object.image)};
}

absl::StatusOr<Voxelized> Load(const VoxelizeArguments& arguments, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const InputKind kind, InputKindOf(arguments.input, arguments.image));
  if (kind == InputKind::kMesh) return FromMesh(arguments, context);
  if (kind == InputKind::kImage) return FromImage(arguments, context);
  return absl::InvalidArgumentError(arguments.input + ": is a volume already");
}

std::string SummaryOf(const VoxelizeArguments& arguments, const Voxelized& result) {
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"input\":", JsonString(arguments.input),
             ",\"output\":", JsonString(arguments.output), ',', result.source.json,
             ",\"volume\":", VolumeJson(result.volume, std::nullopt), "}\n");
  } else {
    text.Add(result.source.text, VolumeText(result.volume, std::nullopt),
             "written:     ", arguments.output, '\n');
  }
  return std::move(text).Take();
}

}  // namespace

void AddVoxelize(CLI::App& command, VoxelizeArguments& arguments) {
  AddInput(command, "INPUT", arguments.input, "Mesh or image file");
  AddOutput(command, arguments.output, "Volume", {".exr", ".bccb"});
  AddGrid(command, arguments.grid);
  AddImage(command, arguments.image);
  AddCommonHere(command, arguments.common);
}

ExitCode Run(const VoxelizeArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const ProgressBar bar(arguments.common.progress);
  bar.Begin("reading", arguments.input);
  const absl::StatusOr<Voxelized> result = Load(arguments, team.context());
  if (!result.ok()) return Fail(result.status());
  bar.Begin("writing", arguments.output);
  const absl::Status written = WriteVolumeFile(arguments.output, result->volume, team.context());
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, *result));
}

}  // namespace bccskel::cli
