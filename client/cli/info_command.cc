#include <utility>

#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/image_summary.h"
#include "client/cli/json_text.h"
#include "client/cli/load_image.h"
#include "client/cli/load_object.h"
#include "client/cli/local_team.h"
#include "client/cli/mesh_summary.h"
#include "client/cli/volume_summary.h"
#include "core/certificate/certificate.h"
#include "core/import/mesh/mesh_file.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

std::string Wrapped(const InfoArguments& arguments, const std::string& kind,
                    const std::string& json) {
  return "{\"file\":" + JsonString(arguments.file) + ",\"kind\":\"" + kind + "\",\"" + kind +
         "\":" + json + "}\n";
}

ExitCode AboutMesh(const InfoArguments& arguments) {
  const absl::StatusOr<TriangleMesh> mesh = ReadMeshFile(arguments.file);
  if (!mesh.ok()) return Fail(mesh.status());
  const MeshReport report = AnalyzeMesh(*mesh);
  if (arguments.common.summary == SummaryStyle::kText) return Print(MeshText(report));
  return Print(Wrapped(arguments, "mesh", MeshJson(report)));
}

ExitCode AboutImage(const InfoArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<ImageObject> object =
      ConvertImageFile(arguments.file, arguments.image, KeptVoxels::kNone, team.context());
  if (!object.ok()) return Fail(object.status());
  const absl::StatusOr<ImageValues> values =
      ReadImageValues(arguments.file, arguments.image.open, team.context());
  if (!values.ok()) return Fail(values.status());
  if (arguments.common.summary == SummaryStyle::kText) {
    return Print(ImageText(object->image) + ValuesText(*values));
  }
  return Print(Wrapped(arguments, "image", ImageJson(object->image, *values)));
}

ExitCode AboutVolume(const InfoArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<Volume> volume = ReadVolumeFile(arguments.file, {}, team.context());
  if (!volume.ok()) return Fail(volume.status());
  const absl::StatusOr<BettiNumbers> betti = CountBettiNumbers(*volume, team.context());
  if (!betti.ok()) return Fail(betti.status());
  if (arguments.common.summary == SummaryStyle::kText) return Print(VolumeText(*volume, *betti));
  return Print(Wrapped(arguments, "volume", VolumeJson(*volume, *betti)));
}

}  // namespace

ExitCode Run(const InfoArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.file, arguments.image);
  if (!kind.ok()) return Fail(kind.status());
  if (*kind == InputKind::kImage) return AboutImage(arguments, stop);
  return *kind == InputKind::kMesh ? AboutMesh(arguments) : AboutVolume(arguments, stop);
}

}  // namespace bccskel::cli
