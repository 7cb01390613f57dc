#include "client/cli/result_object.h"

#include <cmath>
#include <utility>

#include "client/cli/console.h"
#include "client/cli/load_image.h"
#include "client/cli/load_object.h"
#include "client/cli/object_fit.h"
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

namespace {

// Whether a mesh is to be filled on the grid of the result: unless another is asked for, or it was
// none of a mesh.
bool TakesGridOf(const view::ResultDocument& result, const ResultArguments& arguments) {
  const VoxelizeOptions& grid = arguments.grid;
  if (grid.points.has_value() || grid.spacing.has_value()) return false;
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.object, arguments.image);
  if (!kind.ok() || *kind != InputKind::kMesh || !result.placement.has_value()) return false;
  const auto& [x, y, z] = result.placement->spacing;
  return x == y && y == z;
}

// Needs: TakesGridOf().
absl::StatusOr<Volume> FillOnGridOf(const view::ResultDocument& result,
                                    const ResultArguments& arguments,
                                    const exec::Context& context) {
  const Placement& placement = *result.placement;
  VoxelizeOptions grid = arguments.grid;
  grid.spacing = placement.spacing[0];
  BCCSKEL_ASSIGN_OR_RETURN(Volume centered,
                           LoadObject(arguments.object, grid, arguments.image, context));
  const double off = std::abs(centered.placement().origin[0] - placement.origin[0]);
  if (off < 0.01 * placement.spacing[0]) return centered;
  grid.shift = GridShift::kOffCenter;
  return LoadObject(arguments.object, grid, arguments.image, context);
}

// The object as it was thinned.
absl::StatusOr<Volume> LoadPrepared(const ResultArguments& arguments,
                                    const view::ResultDocument& result,
                                    const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(
      Volume object, TakesGridOf(result, arguments)
                         ? FillOnGridOf(result, arguments, context)
                         : LoadObject(arguments.object, arguments.grid, arguments.image, context));
  if (!result.preparing.Wanted()) return object;
  exec::UnlimitedMemory memory;
  BCCSKEL_ASSIGN_OR_RETURN(PreparedObject prepared,
                           Prepare(object, result.preparing, memory, context));
  return std::move(prepared.object);
}

}  // namespace

absl::StatusOr<ResultAndObject> LoadResultAndObject(const ResultArguments& arguments,
                                                    const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(view::ResultDocument result, view::ReadResultDocument(arguments.result));
  BCCSKEL_ASSIGN_OR_RETURN(Volume object, LoadPrepared(arguments, result, context));
  const absl::Status fits = CheckObjectFits(result, object);
  if (!fits.ok()) return WithPath(fits, arguments.object);
  const uint64_t points = object.PointCount();
  if (points != result.object_points) {
    Warn(arguments.object + ": has " + exporting::GroupedDigits(points) + " points, but " +
         arguments.result + " was made from " + exporting::GroupedDigits(result.object_points));
  }
  return ResultAndObject{std::move(result), std::move(object)};
}

}  // namespace bccskel::cli
