#include "client/cli/load_object.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/console.h"
#include "client/export/picture/caption.h"
#include "client/view/result_balls.h"
#include "core/exec/machine_memory.h"
#include "core/exec/status_macros.h"
#include "core/import/image/open_image.h"
#include "core/import/mesh/mesh_file.h"
#include "core/io/volume_file.h"
#include "core/mask/mask_converter.h"

namespace bccskel::cli {
namespace {

// Boxes may differ by this part of their edge and by two cells, because grids differ.
constexpr double kSlack = 0.1;
constexpr double kSlackCells = 2;
// Volumes may differ by this factor.
constexpr double kMostVolumes = 2;

struct Range {
  double low;
  double high;
};
using LatticeBox = std::array<Range, 3>;

constexpr std::string_view kOtherObject =
    "is not what the result was made from, or was read with other options (those that select the "
    "object and its grid, such as --threshold, --voxel-size or --spacing, are needed again)";

// Needs: at least one point.
LatticeBox BoxOf(const Volume& object) {
  constexpr Range kNone = {2.0 * kMaxExtentCells, -1};
  LatticeBox box = {kNone, kNone, kNone};
  object.ForEachPoint([&](LatticePoint p) {
    const std::array<int32_t, 3> place = {p.x, p.y, p.z};
    for (size_t axis = 0; axis < 3; ++axis) {
      box[axis] = {std::min<double>(box[axis].low, place[axis]),
                   std::max<double>(box[axis].high, place[axis])};
    }
  });
  return box;
}

absl::Status CheckBoxes(const view::ResultDocument& result, const Volume& object) {
  const LatticeBox box = BoxOf(object);
  for (const OpenBall& ball : view::BallsOf(result, object.placement())) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = box[axis];
      const double unit = object.placement().spacing[axis] / 2;
      const double slack = kSlack * (high - low) + 2 * kSlackCells;
      const double inside = std::min(ball.center[axis] - low, high - ball.center[axis]);
      if (-inside <= slack) continue;  // balls may reach beyond the border that cuts a limb
      return absl::InvalidArgumentError(
          absl::StrFormat("%s: the result's object reaches %.4g beyond this one's box along the "
                          "axis %c of its grid",
                          kOtherObject, -inside * unit, "xyz"[axis]));
    }
  }
  return absl::OkStatus();
}

double VolumeOf(uint64_t points, const Placement& placement) {
  const auto& [x, y, z] = placement.spacing;
  return static_cast<double>(points) * x * y * z / 2;
}

absl::Status CheckVolumes(const view::ResultDocument& result, const Volume& object) {
  if (!result.placement.has_value()) return absl::OkStatus();
  const double here = VolumeOf(object.PointCount(), object.placement());
  const double there = VolumeOf(result.object_points, *result.placement);
  if (std::max(here, there) <= kMostVolumes * std::min(here, there)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s: its volume is %.4g, that of the result's object %.4g", kOtherObject, here, there));
}

}  // namespace

absl::Status CheckObjectFits(const view::ResultDocument& result, const Volume& object) {
  if (object.empty() && result.object_points == 0) return absl::OkStatus();
  if (object.empty()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: it has no point on the result's grid", kOtherObject));
  }
  BCCSKEL_RETURN_IF_ERROR(CheckBoxes(result, object));
  return CheckVolumes(result, object);
}

absl::Status NoSuchLabel(const std::string& path, const ImageArguments& arguments) {
  if (arguments.labels.empty()) {
    return absl::InvalidArgumentError("no voxel has a label: all are 0, the background");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path, arguments.open));
  return NoSuchLabel(arguments.labels, *source);
}

namespace {

// The options that select the object, as given.
std::string SelectionOf(const ImageArguments& arguments) {
  std::string words;
  if (!arguments.labels.empty()) words = "--label " + absl::StrJoin(arguments.labels, ",");
  if (!arguments.range.empty()) words = "--range " + arguments.range;
  if (arguments.threshold.has_value()) {
    words = absl::StrFormat("--threshold %g", *arguments.threshold);
  }
  if (arguments.below.has_value()) words = absl::StrFormat("--below %g", *arguments.below);
  if (arguments.invert) words += words.empty() ? "--invert" : " --invert";
  return words;
}

// The reason why no voxel belongs to the object; reads the image again.
absl::StatusOr<std::string> WhyEmpty(const std::string& path, const ImageArguments& arguments) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path, arguments.open));
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int32_t z = 0; z < source->info().size.nz; ++z) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source->NextSlice());
    const auto add = [&](const auto value) {
      low = std::min(low, static_cast<double>(value));  // both ignore NaN
      high = std::max(high, static_cast<double>(value));
    };
    std::visit([&](const auto values) { std::ranges::for_each(values, add); }, slice.values);
  }
  if (low > high) return "no voxel belongs to the object: all are NaN";
  const std::string selection = SelectionOf(arguments);
  if (selection.empty()) return "no voxel belongs to the object: all are 0, the background";
  return selection +
         absl::StrFormat(" selects no voxel; values range from %.7g to %.7g", low, high);
}

absl::StatusOr<ImageObject> Convert(const std::string& path, const ImageArguments& arguments,
                                    KeptVoxels kept, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path, arguments.open));
  BCCSKEL_ASSIGN_OR_RETURN(ImageObject object, ConvertImage(*source, arguments, kept, context));
  if (object.image.voxels > 0) return object;
  if (!arguments.labels.empty() && !arguments.invert) return NoSuchLabel(path, arguments);
  BCCSKEL_ASSIGN_OR_RETURN(object.image.warnings.emplace_back(), WhyEmpty(path, arguments));
  return object;
}

}  // namespace

absl::StatusOr<ImageObject> ConvertImageFile(const std::string& path,
                                             const ImageArguments& arguments, KeptVoxels kept,
                                             const exec::Context& context) {
  absl::StatusOr<ImageObject> object = Convert(path, arguments, kept, context);
  if (!object.ok()) return WithPath(object.status(), path);
  if (arguments.mask.part.index > 0) return object;  // the first of the ranks that read it warns
  for (const std::string& warning : object->image.warnings) {
    Warn(absl::StrCat(path, ": ", warning));
  }
  return object;
}

exporting::World WorldOf(const ImageInfo& info) { return {info.world, info.unit}; }

absl::Status CheckConversion(const std::string& path, const ImageArguments& arguments,
                             const BettiNumbers& mask, const BettiNumbers& object) {
  const std::string changes = DescribeChanges(mask, object);
  if (changes.empty()) return absl::OkStatus();
  const std::string message = path + ": the conversion to the lattice changed " + changes;
  if (!arguments.mask.sampling.has_value()) return absl::InternalError(message);
  Warn(message);
  return absl::OkStatus();
}

absl::StatusOr<InputKind> InputKindOf(const std::string& path) {
  const std::string name = absl::AsciiStrToLower(path);
  if (IsMeshPath(path)) return InputKind::kMesh;
  if (name.ends_with(".exr") || name.ends_with(".bccb")) return InputKind::kVolume;
  if (IsImagePath(path)) return InputKind::kImage;
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(path, none);
  if (!std::filesystem::exists(status)) {
    return absl::NotFoundError("cannot open '" + path + "': No such file or directory");
  }
  if (std::filesystem::is_other(status)) {
    return absl::InvalidArgumentError(
        path + ": is a pipe or a device, which cannot be read twice; save it to a file first");
  }
  if (BeginsLikeImage(path)) return InputKind::kImage;
  if (BeginsLikeMesh(path)) return InputKind::kMesh;
  constexpr std::array kResults = {".json", ".swc", ".graphml", ".csv", ".html", ".svg"};
  if (std::ranges::any_of(kResults, [&](const char* ending) { return name.ends_with(ending); })) {
    return absl::InvalidArgumentError(
        path +
        ": is no mesh, volume or image; bccskel view shows a result in .json, and bccskel "
        "convert writes it in other formats");
  }
  return absl::InvalidArgumentError(
      path +
      ": format not supported; there are meshes (.obj, .stl, .ply, .off, .glb, .gltf, .vtk, .vtp, "
      ".gii, each also with .gz, and surfaces of FreeSurfer), "
      "volumes (.exr, .bccb) and images (.nii, .nrrd, .tif, .png, .mha, .inr, .npy, .npz, .vol, "
      ".raw, "
      "folders of slices or OME-Zarr, ...); save another image as NIfTI or NRRD, which keep its "
      "place, or as TIFF, PNG or .npy");
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
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);  // from a folder's name
  return path.substr(path.rfind('/') + 1);
}

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

// Whether to fill the mesh on the result's grid: not if the arguments give another grid or the
// result is not of a mesh.
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
  grid.large_cells = LargeCells::kAccept;
  if (placement.direction == Placement().direction) grid.axes = LatticeAxes::kWorld;
  BCCSKEL_ASSIGN_OR_RETURN(Volume centered,
                           LoadObject(arguments.object, grid, arguments.image, context));
  const double off = DistanceBetween(centered.placement().origin, placement.origin);
  if (off < 0.01 * placement.spacing[0]) return centered;
  grid.shift = GridShift::kOffCenter;
  return LoadObject(arguments.object, grid, arguments.image, context);
}

// The object after preparation, as it was thinned.
absl::StatusOr<Volume> LoadPrepared(const ResultArguments& arguments,
                                    const view::ResultDocument& result,
                                    const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(
      Volume object, TakesGridOf(result, arguments)
                         ? FillOnGridOf(result, arguments, context)
                         : LoadObject(arguments.object, arguments.grid, arguments.image, context));
  if (!result.preparing.Wanted()) return object;
  exec::MachineMemory memory;
  BCCSKEL_ASSIGN_OR_RETURN(PreparedObject prepared,
                           Prepare(object, result.preparing, memory, context));
  return std::move(prepared.object);
}

}  // namespace

std::string_view LocalCommand(const SkeletonizeArguments& arguments) {
  return arguments.accepted == AcceptedInput::kVolumeOnly ? "bccskel skeletonize" : "--local";
}

ExitCode FailComputing(const ComputeArguments& arguments, const absl::Status& error,
                       std::string_view local) {
  if (arguments.place != Place::kServer) {
    const absl::Status here = absl::IsDeadlineExceeded(error)
                                  ? absl::DeadlineExceededError(absl::StrFormat(
                                        "not done within the %g s of --timeout",
                                        std::chrono::duration<double>(arguments.timeout).count()))
                                  : error;
    return Fail(WithPath(here, arguments.input));
  }
  return FailOnServer(arguments.server, error, local);
}

absl::StatusOr<ResultAndObject> LoadResultAndObject(const ResultArguments& arguments,
                                                    const ProgressBar& bar,
                                                    const exec::Context& context) {
  bar.Begin("reading", arguments.result);
  BCCSKEL_ASSIGN_OR_RETURN(view::ResultDocument result,
                           view::ReadResultDocument(arguments.result, context.stop));
  if (arguments.object.empty()) {
    return ResultAndObject{std::string(FileName(arguments.result)), std::move(result),
                           std::nullopt};
  }
  bar.Begin("reading", arguments.object);
  BCCSKEL_ASSIGN_OR_RETURN(Volume object, LoadPrepared(arguments, result, context));
  const absl::Status fits = CheckObjectFits(result, object);
  if (!fits.ok()) return WithPath(fits, arguments.object);
  const uint64_t points = object.PointCount();
  if (points != result.object_points) {
    Warn(arguments.object + ": has " + exporting::GroupedDigits(points) + " points, but " +
         arguments.result + " was made from " + exporting::GroupedDigits(result.object_points) +
         (result.certificate.sampled && !arguments.image.mask.sampling.has_value()
              ? " of a sampling: add --sampling and --density as they were"
              : ""));
  }
  return ResultAndObject{std::string(FileName(arguments.object)), std::move(result),
                         std::move(object)};
}

}  // namespace bccskel::cli
