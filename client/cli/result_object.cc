#include "client/cli/result_object.h"

#include <utility>

#include "client/cli/console.h"
#include "client/cli/load_image.h"
#include "client/cli/load_object.h"
#include "client/export/picture/caption.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {

absl::StatusOr<Volume> LoadObject(const std::string& path, const VoxelizeOptions& grid,
                                  const ImageArguments& image, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const InputKind kind, InputKindOf(path, image));
  if (kind == InputKind::kVolume) return ReadVolumeFile(path, {}, context);
  if (kind == InputKind::kImage) {
    BCCSKEL_ASSIGN_OR_RETURN(ImageObject object,
                             ConvertImageFile(path, image, KeptVoxels::kNone, context));
    return std::move(object.volume);
  }
  BCCSKEL_ASSIGN_OR_RETURN(VoxelizeResult result, VoxelizeFile(path, grid, context));
  return std::move(result.volume);
}

absl::StatusOr<ResultAndObject> LoadResultAndObject(const ResultArguments& arguments,
                                                    const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(view::ResultDocument result, view::ReadResultDocument(arguments.result));
  BCCSKEL_ASSIGN_OR_RETURN(Volume object,
                           LoadObject(arguments.object, arguments.grid, arguments.image, context));
  const uint64_t points = object.PointCount();
  if (points != result.object_points) {
    Warn(arguments.object + ": has " + exporting::GroupedDigits(points) + " points, but " +
         arguments.result + " was made from " + exporting::GroupedDigits(result.object_points));
  }
  return ResultAndObject{std::move(result), std::move(object)};
}

}  // namespace bccskel::cli
