#ifndef BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_
#define BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"
#include "core/voxelize/voxelize.h"

namespace bccskel::cli {

enum class InputKind { kMesh, kVolume };

// What a file is by its name.
// Errors: UNIMPLEMENTED for image formats, which are not read yet; INVALID_ARGUMENT for the rest.
absl::StatusOr<InputKind> InputKindOf(const std::string& path);

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
