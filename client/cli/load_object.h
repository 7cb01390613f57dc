#ifndef BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_
#define BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/image_arguments.h"
#include "core/exec/context.h"
#include "core/import/voxelize/voxelize.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

enum class InputKind { kMesh, kVolume, kImage };

// What a file is by its name. Errors: INVALID_ARGUMENT for other endings.
absl::StatusOr<InputKind> InputKindOf(const std::string& path);
// The same, but an image whatever its name where the arguments tell how its raw voxels lie.
absl::StatusOr<InputKind> InputKindOf(const std::string& path, const ImageArguments& image);

// "a mesh", "a volume" or "an image".
std::string_view InputKindPhrase(InputKind kind);

// The same error with the path in front, unless it is in there.
absl::Status WithPath(const absl::Status& error, const std::string& path);

// The points of a solid when neither their number nor the spacing is given.
inline constexpr uint64_t kDefaultPoints = 850'000;

// Reads a mesh and fills it. Without points or spacing, kDefaultPoints.
// Errors: as ReadMeshFile() and Voxelize(); every message names the path.
absl::StatusOr<VoxelizeResult> VoxelizeFile(const std::string& path, const VoxelizeOptions& grid,
                                            const exec::Context& context);

// The last part of a path: what titles and summaries call a file.
std::string_view FileName(std::string_view path);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_
