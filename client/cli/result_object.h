#ifndef BCCSKEL_CLIENT_CLI_RESULT_OBJECT_H_
#define BCCSKEL_CLIENT_CLI_RESULT_OBJECT_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// A volume as it is, a mesh filled, an image converted.
// Errors: those of ReadVolumeFile(), VoxelizeFile() and ConvertImageFile(), with the path.
absl::StatusOr<Volume> LoadObject(const std::string& path, const VoxelizeOptions& grid,
                                  const ImageArguments& image, const exec::Context& context);

// A result and the object that it was made from.
struct ResultAndObject {
  view::ResultDocument result;
  Volume object;
};

// Reads both, and makes of the object what the result says was thinned: a mesh is filled on a grid
// of its spacing, unless the arguments ask for another, and all is prepared again. Warns when the
// object then has not the number of points that the result speaks of. Errors: those of
// ReadResultDocument(), LoadObject(), Prepare() and CheckObjectFits(), with the path.
absl::StatusOr<ResultAndObject> LoadResultAndObject(const ResultArguments& arguments,
                                                    const exec::Context& context);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_RESULT_OBJECT_H_
