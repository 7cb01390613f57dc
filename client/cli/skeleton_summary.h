#ifndef BCCSKEL_CLIENT_CLI_SKELETON_SUMMARY_H_
#define BCCSKEL_CLIENT_CLI_SKELETON_SUMMARY_H_

#include <optional>
#include <string>
#include <vector>

#include "client/cli/arguments.h"
#include "client/cli/load_image.h"
#include "core/import/mesh/mesh_report.h"
#include "core/import/voxelize/voxelize.h"
#include "core/pipeline/skeletonize.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

struct WrittenFile {
  std::string path;
  std::string note;  // what its format could not hold; may be empty
};

// What became of a mesh before thinning.
struct MeshStage {
  MeshReport mesh;
  FillRule fill = FillRule::kParity;
  std::vector<std::string> warnings;
};

// All that `skeletonize` and `submit` have to say at their end.
struct SkeletonSummary {
  const SkeletonizeArguments& arguments;
  const Volume& object;
  const SkeletonizeResult& result;
  std::optional<MeshStage> mesh;
  std::optional<ImageStage> image;
  std::vector<WrittenFile> files;
  double seconds = 0;  // from start to end, as the user waited
};

// "denoised in 2 passes +3 -40, 5 cavities filled +60": with points added and removed.
std::string PreparingPhrase(const std::vector<PreparingStep>& steps);

std::string SkeletonSummaryText(const SkeletonSummary& summary);
// One JSON object on one line; README.md of this folder lists its keys.
std::string SkeletonSummaryJson(const SkeletonSummary& summary);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_SKELETON_SUMMARY_H_
