#include <utility>

#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/json_text.h"
#include "client/cli/load_object.h"
#include "client/cli/local_team.h"
#include "client/cli/mesh_summary.h"
#include "client/cli/volume_summary.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

std::string SummaryOf(const VoxelizeArguments& arguments, const VoxelizeResult& result) {
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"input\":", JsonString(arguments.mesh),
             ",\"output\":", JsonString(arguments.output), ",\"mesh\":", MeshJson(result.mesh),
             ",\"fill\":\"", FillRuleName(result.fill),
             "\",\"volume\":", VolumeJson(result.volume, std::nullopt), ",\"warnings\":[");
    for (size_t n = 0; n < result.warnings.size(); ++n) {
      text.Add(n > 0 ? "," : "", JsonString(result.warnings[n]));
    }
    text.Add("]}\n");
  } else {
    text.Add("mesh:        ", MeshPhrase(result.mesh), "\nfilled by:   ", FillRuleName(result.fill),
             '\n', VolumeText(result.volume, std::nullopt), "written:     ", arguments.output,
             '\n');
  }
  return std::move(text).Take();
}

}  // namespace

ExitCode Run(const VoxelizeArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.mesh);
  if (!kind.ok()) return Fail(kind.status());
  if (*kind != InputKind::kMesh) {
    return Fail(absl::InvalidArgumentError(arguments.mesh + ": is a volume already"));
  }
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<VoxelizeResult> result =
      VoxelizeFile(arguments.mesh, arguments.grid, team.context());
  if (!result.ok()) return Fail(result.status());
  for (const std::string& warning : result->warnings) Warn(arguments.mesh + ": " + warning);
  const absl::Status written =
      WriteVolumeFile(arguments.output, result->volume, {}, team.context());
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, *result));
}

}  // namespace bccskel::cli
