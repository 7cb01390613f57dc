#ifndef BCCSKEL_CLIENT_CLI_RESULT_OBJECT_H_
#define BCCSKEL_CLIENT_CLI_RESULT_OBJECT_H_

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// A result and the object that it was made from.
struct ResultAndObject {
  view::ResultDocument result;
  Volume object;
};

// Reads both; a mesh is filled. Warns when the object has not the number of points that the result
// speaks of.
// Errors: those of ReadResultDocument(), VoxelizeFile() and ReadVolumeFile(), with the path.
absl::StatusOr<ResultAndObject> LoadResultAndObject(const ResultArguments& arguments,
                                                    const exec::Context& context);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_RESULT_OBJECT_H_
