#ifndef BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_
#define BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/image_options.h"
#include "client/export/world.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"
#include "core/import/voxelize/voxelize.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// Whether a result can be that of an object, in this or another grid: its balls lie in the object's
// box, and the object that it was made from has about the same volume.
// Errors: INVALID_ARGUMENT with what does not match.
absl::Status CheckObjectFits(const view::ResultDocument& result, const Volume& object);

// The object of a file.
// Errors: as OpenImage() and ConvertImage(), and labels of no voxel; every message names the path.
absl::StatusOr<ImageObject> ConvertImageFile(const std::string& path,
                                             const ImageArguments& arguments, KeptVoxels kept,
                                             const exec::Context& context);

// That no voxel has a wanted label, and which labels the image has. Errors: that.
absl::Status NoSuchLabel(const std::string& path, const ImageArguments& arguments);

// What the image says of its world.
exporting::World WorldOf(const ImageInfo& info);

// OK where the object has the topology of the mask that it was made from. A sampling may change
// it, which is only said on standard error; the exact conversion may not.
// Errors: INTERNAL, with what changed.
absl::Status CheckConversion(const std::string& path, const ImageArguments& arguments,
                             const BettiNumbers& mask, const BettiNumbers& object);

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

// A volume as it is, a mesh filled, an image converted.
// Errors: those of ReadVolumeFile(), VoxelizeFile() and ConvertImageFile(), with the path.
absl::StatusOr<Volume> LoadObject(const std::string& path, const VoxelizeOptions& grid,
                                  const ImageArguments& image, const exec::Context& context);

// A result and the object that it was made from.
struct ResultAndObject {
  view::ResultDocument result;
  Volume object;
};

// Says why nothing was computed, and where that was. Returns the exit code.
ExitCode FailComputing(const ComputeArguments& arguments, const absl::Status& error);

// Reads both, and makes of the object what the result says was thinned: a mesh is filled on a grid
// of its spacing, unless the arguments ask for another, and all is prepared again. Warns when the
// object then has not the number of points that the result speaks of. Errors: those of
// ReadResultDocument(), LoadObject(), Prepare() and CheckObjectFits(), with the path.
absl::StatusOr<ResultAndObject> LoadResultAndObject(const ResultArguments& arguments,
                                                    const exec::Context& context);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_
