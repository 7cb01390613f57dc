#include "client/cli/load_object.h"

#include <algorithm>
#include <array>

#include "core/mesh/mesh_file.h"

namespace bccskel::cli {
namespace {

// Formats of cubic images, with the compressed forms that are common.
constexpr std::array<std::string_view, 17> kImageEndings = {
    ".nrrd", ".nhdr", ".nii", ".nii.gz", ".npy", ".npz",   ".tif", ".tiff", ".mha",
    ".mhd",  ".vol",  ".inr", ".inr.gz", ".vti", ".pgm3d", ".dcm", ".raw"};

std::string LowerCase(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

// The same error with the path in front, unless it is in there.
absl::Status WithPath(const absl::Status& error, const std::string& path) {
  const std::string message(error.message());
  if (message.find(path) != message.npos) return error;
  return absl::Status(error.code(), path + ": " + message);
}

}  // namespace

absl::StatusOr<InputKind> InputKindOf(const std::string& path) {
  const std::string name = LowerCase(path);
  if (HasMeshFileName(name)) return InputKind::kMesh;
  if (name.ends_with(".exr") || name.ends_with(".bccb")) return InputKind::kVolume;
  for (const std::string_view ending : kImageEndings) {
    if (!name.ends_with(ending)) continue;
    return absl::UnimplementedError(path + ": format not supported: images (" +
                                    std::string(ending) + ") are not read yet");
  }
  return absl::InvalidArgumentError(path +
                                    ": format not supported; there are meshes (.obj, .stl, .ply, "
                                    ".off, each also with .gz) and volumes (.exr, .bccb)");
}

absl::StatusOr<VoxelizeResult> VoxelizeFile(const std::string& path, const VoxelizeOptions& grid,
                                            const exec::Context& context) {
  const absl::StatusOr<TriangleMesh> mesh = ReadMeshFile(path);
  if (!mesh.ok()) return WithPath(mesh.status(), path);
  VoxelizeOptions options = grid;
  if (!options.points.has_value() && !options.spacing.has_value()) options.points = kDefaultPoints;
  absl::StatusOr<VoxelizeResult> result = Voxelize(*mesh, options, context);
  if (!result.ok()) return WithPath(result.status(), path);
  return result;
}

std::string_view FileName(std::string_view path) { return path.substr(path.rfind('/') + 1); }

}  // namespace bccskel::cli
