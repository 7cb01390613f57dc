#ifndef BCCSKEL_CLIENT_CLI_IMAGE_OPTIONS_H_
#define BCCSKEL_CLIENT_CLI_IMAGE_OPTIONS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/import/image/foreground.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"
#include "core/import/voxelize/voxelize.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/mask_converter.h"
#include "core/volume/volume.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options for filling a mesh with lattice points.
void AddGrid(CLI::App& command, VoxelizeOptions& grid);

// The command line's options for turning an image into an object.
struct ImageArguments {
  ImageOptions open;
  std::vector<uint64_t> labels;
  std::string range;  // "LOW,HIGH"; a missing end is open
  std::optional<double> threshold;
  std::optional<double> below;
  bool invert = false;
  MaskOptions mask;
  bool given = false;  // whether any of these options was given
};

// Output images of the skeleton, on the grid of the input image. Empty: none.
struct SkeletonImages {
  std::string branches;  // the nearest branch of each voxel of the object
  std::string curves;    // the voxels that curves run through

  bool wanted() const { return !branches.empty() || !curves.empty(); }
};

// Adds the options that select the voxels of the object and their conversion to lattice points.
void AddMaskOptions(CLI::App& command, ImageArguments& arguments);
// The same for images of labels.
void AddLabelOptions(CLI::App& command, ImageArguments& arguments);

// Adds options for the layout of a file's voxels and their placement in the world.
void AddImageLayout(CLI::App& command, ImageArguments& arguments);

// Adds all options of commands that take images.
void AddImage(CLI::App& command, ImageArguments& arguments);
// The same for a command that takes images of labels.
void AddLabelImage(CLI::App& command, ImageArguments& arguments);

void AddSkeletonImages(CLI::App& command, SkeletonImages& images);

// Errors: INVALID_ARGUMENT, as ForegroundRule's.
absl::StatusOr<ForegroundRule> ForegroundOf(const ImageArguments& arguments);

// An image before its conversion to an object.
struct ImageStage {
  ImageInfo info;
  uint64_t voxels = 0;                // of the foreground
  BettiNumbers mask;                  // topology, counted on the image's own grid
  std::vector<std::string> warnings;  // about the selection of the object
};

struct ImageObject {
  Volume volume;
  ImageStage image;
  std::optional<LabeledObjects> voxels = std::nullopt;  // of the object, as label 1; if requested
};

enum class KeptVoxels : uint8_t { kNone, kAll };

// The warning that this many voxels are NaN.
std::string NanWarning(uint64_t voxels);

// Reads an image slice by slice and converts its foreground, which may be empty.
// Errors: as NextSlice(), ForegroundOf() and MaskConverter.
absl::StatusOr<ImageObject> ConvertImage(ImageSource& source, const ImageArguments& arguments,
                                         KeptVoxels kept, const exec::Context& context);

MaskGrid GridOf(const ImageInfo& info);

struct CollectedLabels {
  ImageInfo info;
  LabeledObjects objects;
  uint64_t left_out = 0;     // labels with too few voxels
  uint64_t not_numbers = 0;  // voxels that are NaN
  // Otsu's, if all labels are requested, but the values look like gray levels.
  std::optional<double> gray_threshold = std::nullopt;
};

// Collects the requested labels with at least `min_voxels` voxels; there may be none.
// Errors: as NextSlice(), LabelCollector and LabelSlice(), this with a hint at --threshold.
absl::StatusOr<CollectedLabels> CollectLabels(ImageSource& source, const ImageArguments& arguments,
                                              uint64_t min_voxels, const exec::Context& context);

// --unit of lengths, one that NanometersOf() knows.
void AddUnit(CLI::App& command, std::optional<std::string>& unit, const char* description);

// The error that no voxel has one of these labels, with those of the image: a source that has not
// been read.
absl::Status NoSuchLabel(const std::vector<uint64_t>& labels, ImageSource& source);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_IMAGE_OPTIONS_H_
