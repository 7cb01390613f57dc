#ifndef BCCSKEL_CLIENT_CLI_IMAGE_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_IMAGE_ARGUMENTS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/foreground.h"
#include "core/import/image/image_options.h"
#include "core/mask/mask_converter.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// How an image becomes an object, as the command line says it.
struct ImageArguments {
  ImageOptions open;
  std::vector<uint64_t> labels;
  std::string range;  // "LOW,HIGH", an end left out is open
  std::optional<double> threshold;
  std::optional<double> below;
  bool invert = false;
  MaskOptions mask;
  bool given = false;  // any of these options
};

// Images, on the grid of the one that was read, that show its skeleton. Empty: none.
struct SkeletonImages {
  std::string branches;  // the nearest branch of every voxel of the object
  std::string curves;    // the voxels that curves run through

  bool wanted() const { return !branches.empty() || !curves.empty(); }
};

// Adds the options that say which voxels are the object and how they become lattice points.
void AddMaskOptions(CLI::App& command, ImageArguments& arguments);
// The same for images of labels.
void AddLabelOptions(CLI::App& command, ImageArguments& arguments);

// Adds how the voxels of a file lie, in it and in the world.
void AddImageLayout(CLI::App& command, ImageArguments& arguments);

// Adds both, to a command that takes images.
void AddImage(CLI::App& command, ImageArguments& arguments);
// The same for a command that takes images of labels.
void AddLabelImage(CLI::App& command, ImageArguments& arguments);

void AddSkeletonImages(CLI::App& command, SkeletonImages& images);

// Errors: INVALID_ARGUMENT, as ForegroundRule's.
absl::StatusOr<ForegroundRule> ForegroundOf(const ImageArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_IMAGE_ARGUMENTS_H_
