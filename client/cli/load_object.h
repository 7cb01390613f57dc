#ifndef BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_
#define BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/image_options.h"
#include "client/cli/progress_bar.h"
#include "client/export/world.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"
#include "core/import/voxelize/voxelize.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// Whether the result can belong to the object, on the same or another grid: its balls lie in the
// object's box, and both objects have about the same volume.
// Errors: INVALID_ARGUMENT with what does not match.
absl::Status CheckObjectFits(const view::ResultDocument& result, const Volume& object);

// Reads a file as an object.
// Errors: as OpenImage() and ConvertImage(); no voxel with a requested label. Every message names
//         the path.
absl::StatusOr<ImageObject> ConvertImageFile(const std::string& path,
                                             const ImageArguments& arguments, KeptVoxels kept,
                                             const exec::Context& context);

// The error that no voxel has a requested label, with the labels of the image.
absl::Status NoSuchLabel(const std::string& path, const ImageArguments& arguments);

// The axes and the unit that the image states.
exporting::World WorldOf(const ImageInfo& info);

// Checks that the object has the topology of its mask. A sampling may change it, which causes only
// a warning on standard error; the exact conversion may not.
// Errors: INTERNAL with the difference.
absl::Status CheckConversion(const std::string& path, const ImageArguments& arguments,
                             const BettiNumbers& mask, const BettiNumbers& object);

enum class InputKind { kMesh, kVolume, kImage };

// The kind of file by its ending. Errors: INVALID_ARGUMENT for other endings.
absl::StatusOr<InputKind> InputKindOf(const std::string& path);
// The same, but an image regardless of its ending if `image` states the layout of raw voxels.
absl::StatusOr<InputKind> InputKindOf(const std::string& path, const ImageArguments& image);

// "a mesh", "a volume" or "an image".
std::string_view InputKindPhrase(InputKind kind);

// The same error with the path before its message, unless the message contains it.
absl::Status WithPath(const absl::Status& error, const std::string& path);

// The default number of points if neither points nor spacing are given.
inline constexpr uint64_t kDefaultPoints = 850'000;

// Reads a mesh and fills it; by default with kDefaultPoints.
// Errors: as ReadMeshFile() and Voxelize(); every message names the path.
absl::StatusOr<VoxelizeResult> VoxelizeFile(const std::string& path, const VoxelizeOptions& grid,
                                            const exec::Context& context);

// The last part of a path, for titles and summaries.
std::string_view FileName(std::string_view path);

// Reads a volume, fills a mesh or converts an image.
// Errors: those of ReadVolumeFile(), VoxelizeFile() and ConvertImageFile(), with the path.
absl::StatusOr<Volume> LoadObject(const std::string& path, const VoxelizeOptions& grid,
                                  const ImageArguments& image, const exec::Context& context);

// A result and the object that it was made from, if given.
struct ResultAndObject {
  std::string title;  // the file name of the object, or of the result
  view::ResultDocument result;
  std::optional<Volume> object;
};

// What computes on this machine instead of a server.
std::string_view LocalCommand(const SkeletonizeArguments& arguments);

// Reports why and where computing failed. Returns the exit code.
ExitCode FailComputing(const ComputeArguments& arguments, const absl::Status& error,
                       std::string_view local = "--local");

// Reads the result and the object, each a phase of `bar`, and reproduces the object that was
// thinned: fills a mesh on a grid of the result's spacing, unless the arguments give another, and
// repeats the preparation. Warns if the number of points differs from the result's.
// Errors: those of ReadResultDocument(), LoadObject(), Prepare() and CheckObjectFits(), with the
//         path.
absl::StatusOr<ResultAndObject> LoadResultAndObject(const ResultArguments& arguments,
                                                    const ProgressBar& bar,
                                                    const exec::Context& context);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LOAD_OBJECT_H_
