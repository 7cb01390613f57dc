#include "client/cli/load_object.h"

#include <algorithm>

#include "core/import/image/open_image.h"
#include "core/import/mesh/mesh_file.h"

namespace bccskel::cli {
namespace {

std::string LowerCase(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

}  // namespace

absl::StatusOr<InputKind> InputKindOf(const std::string& path) {
  const std::string name = LowerCase(path);
  if (HasMeshFileName(name)) return InputKind::kMesh;
  if (name.ends_with(".exr") || name.ends_with(".bccb")) return InputKind::kVolume;
  if (IsImagePath(path)) return InputKind::kImage;
  return absl::InvalidArgumentError(
      path +
      ": format not supported; there are meshes (.obj, .stl, .ply, .off, each also with .gz), "
      "volumes (.exr, .bccb) and images (.nii, .nrrd, .tif, .mha, .inr, .npy, .vol, .raw, OME-Zarr "
      "folders, ...)");
}

absl::StatusOr<InputKind> InputKindOf(const std::string& path, const ImageArguments& image) {
  if (image.open.raw.has_value()) return InputKind::kImage;
  return InputKindOf(path);
}

std::string_view InputKindPhrase(InputKind kind) {
  if (kind == InputKind::kMesh) return "a mesh";
  return kind == InputKind::kVolume ? "a volume" : "an image";
}

absl::Status WithPath(const absl::Status& error, const std::string& path) {
  const std::string message(error.message());
  if (message.find(path) != message.npos) return error;
  return absl::Status(error.code(), path + ": " + message);
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

std::string_view FileName(std::string_view path) {
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);  // of a folder
  return path.substr(path.rfind('/') + 1);
}

}  // namespace bccskel::cli
