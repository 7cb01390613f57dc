#ifndef BCCSKEL_CLIENT_CLI_SUMMARIES_H_
#define BCCSKEL_CLIENT_CLI_SUMMARIES_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/cli/arguments.h"
#include "client/cli/load_object.h"
#include "client/export/picture/escape.h"
#include "core/certificate/certificate.h"
#include "core/import/mesh/mesh_report.h"
#include "core/import/voxelize/voxelize.h"
#include "core/pipeline/skeletonize.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

using exporting::JsonString;
std::string JsonStrings(const std::vector<std::string>& texts);  // an array

// "2,775 vertices, 5,558 triangles, watertight, genus 3".
std::string MeshPhrase(const MeshReport& report);

// The facts about a mesh, one per line; and the same as a JSON object.
// `crossings`: pairs of triangles that cross, if they were counted.
std::string MeshText(const MeshReport& report, std::optional<uint64_t> crossings = std::nullopt);
std::string MeshJson(const MeshReport& report, std::optional<uint64_t> crossings = std::nullopt);

// "parity" or "winding".
std::string FillRuleName(FillRule rule);

// The facts about a volume, one per line; and the same as a JSON object. Includes the Betti numbers
// if given.
std::string VolumeText(const Volume& volume, const std::optional<BettiNumbers>& betti);
std::string VolumeJson(const Volume& volume, const std::optional<BettiNumbers>& betti);

// "NIfTI-1, 101 x 101 x 41 uint8, 50,899 voxels".
std::string ImagePhrase(const ImageStage& image);

// The facts about an image and its foreground, one per line; and the same as a JSON object, with
// additional `members`.
std::string ImageText(const ImageStage& image);
std::string ImageJson(const ImageStage& image, const std::string& members = "");

struct WrittenFile {
  std::string path;
  std::string note;  // what its format could not hold; may be empty
};

// One line per file; and the same as a JSON array.
std::string FilesText(const std::vector<WrittenFile>& files);
std::string FilesJson(const std::vector<WrittenFile>& files);

// The beginning of a JSON object: the paths of the result, the object and the output.
std::string FilesJson(const ResultArguments& arguments);

// How a mesh was filled; and the same as members of a JSON object.
struct MeshStage {
  MeshReport mesh;
  FillRule fill = FillRule::kParity;
  uint64_t added_points = 0;
  std::vector<std::string> warnings;
};
MeshStage MeshStageOf(VoxelizeResult& result);  // moves from it what it takes
// "501 points added, so that parts thinner than two lattice units stay whole"; "" if none were.
std::string ThinPartsPhrase(const MeshStage& stage);
std::string MeshStageJson(const MeshStage& stage);

// What `skeletonize` and `submit` report at their end.
struct SkeletonSummary {
  const SkeletonizeArguments& arguments;
  const Volume& object;
  const SkeletonizeResult& result;
  std::optional<MeshStage> mesh;
  std::optional<ImageStage> image;
  std::vector<WrittenFile> files;
  double seconds = 0;  // wall time of the command
};

// "on this machine", or "on" the server's address.
std::string WhereComputed(const ComputeArguments& arguments);

// Whether the topology was kept, from the mask on.
std::string_view KeptJson(const Certificate& certificate);

// "denoised in 2 passes +3 -40, 5 cavities filled +60": with points added and removed.
std::string PreparingPhrase(const std::vector<PreparingStep>& steps);

std::string SkeletonSummaryText(const SkeletonSummary& summary);
// One JSON object on one line; README.md of this folder lists its keys.
std::string SkeletonSummaryJson(const SkeletonSummary& summary);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_SUMMARIES_H_
