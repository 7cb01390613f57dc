#include "client/cli/load_image.h"

#include <utility>
#include <vector>

#include "client/cli/console.h"
#include "client/cli/load_object.h"
#include "core/exec/status_macros.h"
#include "core/image/open_image.h"
#include "core/labels/label_collector.h"
#include "core/mask/mask_converter.h"

namespace bccskel::cli {
namespace {

absl::StatusOr<ImageObject> Convert(const std::string& path, const ImageArguments& arguments,
                                    KeptVoxels kept, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const ForegroundRule rule, ForegroundOf(arguments));
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path, arguments.open));
  const ImageInfo& info = source->info();
  const MaskGrid grid = {info.size.nx, info.size.ny, info.size.nz, info.placement};
  BCCSKEL_ASSIGN_OR_RETURN(MaskConverter converter, MaskConverter::Create(grid, arguments.mask));
  BCCSKEL_ASSIGN_OR_RETURN(LabelCollector collector, LabelCollector::Create(grid, {}));
  std::vector<uint64_t> words(grid.WordsPerSlice());
  for (int32_t z = 0; z < grid.nz; ++z) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source->NextSlice());
    ForegroundSlice(slice, rule, words);
    BCCSKEL_RETURN_IF_ERROR(converter.AddSlice(words, context));
    if (kept == KeptVoxels::kNone) continue;
    BCCSKEL_RETURN_IF_ERROR(collector.AddMaskSlice(words, context));
  }
  BCCSKEL_ASSIGN_OR_RETURN(ConvertedMask mask, std::move(converter).Finish());
  ImageObject object = {std::move(mask.volume), {info, mask.voxels, mask.mask}};
  if (kept == KeptVoxels::kAll) {
    BCCSKEL_ASSIGN_OR_RETURN(object.voxels, std::move(collector).Finish());
  }
  return object;
}

}  // namespace

absl::StatusOr<ImageObject> ConvertImageFile(const std::string& path,
                                             const ImageArguments& arguments, KeptVoxels kept,
                                             const exec::Context& context) {
  absl::StatusOr<ImageObject> object = Convert(path, arguments, kept, context);
  if (!object.ok()) return WithPath(object.status(), path);
  return object;
}

absl::Status CheckConversion(const std::string& path, const ImageArguments& arguments,
                             const BettiNumbers& mask, const BettiNumbers& object) {
  const std::string changes = DescribeChanges(mask, object);
  if (changes.empty()) return absl::OkStatus();
  const std::string message = path + ": the conversion to the lattice changed " + changes;
  if (!arguments.mask.sampling.has_value()) return absl::InternalError(message);
  Warn(message);
  return absl::OkStatus();
}

}  // namespace bccskel::cli
