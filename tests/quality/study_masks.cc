#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/mask/mask_converter.h"
#include "tests/quality/disturb.h"
#include "tests/quality/known_figure.h"
#include "tests/quality/measure.h"
#include "tests/quality/methods.h"
#include "tests/quality/studies.h"

namespace bccskel::quality {
namespace {

// The even points of a lattice are voxels: voxel (i, j, k) at (2i, 2j, 2k).
absl::StatusOr<ConvertedMask> AsVoxels(const Volume& object) {
  const LatticeExtent& extent = object.extent();
  const MaskGrid grid = {.nx = extent.nx, .ny = extent.ny, .nz = extent.nz};
  BCCSKEL_ASSIGN_OR_RETURN(MaskConverter converter, MaskConverter::Create(grid, {}));
  const size_t words = grid.WordsPerRow();
  for (int32_t k = 0; k < extent.nz; ++k) {
    std::vector<uint64_t> slice(grid.WordsPerSlice());
    for (int32_t j = 0; j < extent.ny; ++j) {
      for (int32_t i = 0; i < extent.nx; ++i) {
        if (!object.Contains({2 * i, 2 * j, 2 * k})) continue;
        const auto at = static_cast<size_t>(i);
        slice[static_cast<size_t>(j) * words + at / 64] |= uint64_t{1} << at % 64;
      }
    }
    BCCSKEL_RETURN_IF_ERROR(converter.AddSlice(slice, exec::Context()));
  }
  return std::move(converter).Finish();
}

absl::Status StudyMask(const PlacedFigure& placed, double noise, double threshold) {
  Volume object = placed.object;
  if (noise > 0) object = WithTopologyKeepingNoise(object, noise, 1);
  BCCSKEL_ASSIGN_OR_RETURN(const ConvertedMask mask, AsVoxels(object));
  SkeletonizeOptions options;
  options.pruning.threshold = threshold;
  // This noise is plain flips once every second point is left out.
  options.preparing.cavities = CavityFilling::kOn;
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                           Skeletonize(mask.volume, options, exec::Context()));
  // A voxel is as wide as two units of the lattice that it came from, and as four of its own.
  PlacedFigure converted = placed;
  converted.scale = 2 * placed.scale;
  constexpr double kVoxelMiddle = 1.5;
  converted.shift = 2.0 * placed.shift + Vector{kVoxelMiddle, kVoxelMiddle, kVoxelMiddle};
  const Judgment judged = Judge(converted, result);
  absl::PrintF(
      "{\"study\": \"masks\", \"figure\": \"%s\", \"noise\": %g, \"threshold\": %g, "
      "\"voxels\": %d, \"tips\": %d, \"ends\": %d, \"lost\": %d, \"spurious\": %d, "
      "\"smooth_mean\": %.3f}\n",
      placed.figure.name, noise, threshold, mask.voxels, placed.figure.tips.size(), judged.ends,
      judged.tips.lost, judged.tips.spurious, judged.smooth.mean);
  return absl::OkStatus();
}

}  // namespace

absl::Status StudyMasks(const StudySize& size) {
  for (const KnownFigure& figure : KnownFigures()) {
    if (!figure.turns) continue;
    BCCSKEL_ASSIGN_OR_RETURN(const PlacedFigure placed,
                             Place(Turned(figure, RandomFrame(1)), 2 * size.points));
    for (const double noise : {0.0, 0.05}) {
      for (const double threshold : {4.0, 16.0}) {
        BCCSKEL_RETURN_IF_ERROR(StudyMask(placed, noise, threshold));
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
