#include "client/cli/convert_image.h"

#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/labels/label_collector.h"
#include "core/mask/mask_converter.h"

namespace bccskel::cli {
namespace {

MaskGrid GridOf(const ImageInfo& info) {
  return {info.size.nx, info.size.ny, info.size.nz, info.placement};
}

}  // namespace

absl::StatusOr<ImageObject> ConvertImage(ImageSource& source, const ImageArguments& arguments,
                                         KeptVoxels kept, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const ForegroundRule rule, ForegroundOf(arguments));
  const MaskGrid grid = GridOf(source.info());
  BCCSKEL_ASSIGN_OR_RETURN(MaskConverter converter, MaskConverter::Create(grid, arguments.mask));
  BCCSKEL_ASSIGN_OR_RETURN(LabelCollector collector, LabelCollector::Create(grid, {}));
  std::vector<uint64_t> words(grid.WordsPerSlice());
  for (int32_t z = 0; z < grid.nz; ++z) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source.NextSlice());
    ForegroundSlice(slice, rule, words);
    BCCSKEL_RETURN_IF_ERROR(converter.AddSlice(words, context));
    if (kept == KeptVoxels::kNone) continue;
    BCCSKEL_RETURN_IF_ERROR(collector.AddMaskSlice(words, context));
  }
  BCCSKEL_ASSIGN_OR_RETURN(ConvertedMask mask, std::move(converter).Finish());
  ImageObject object = {std::move(mask.volume), {source.info(), mask.voxels, mask.mask}};
  if (kept == KeptVoxels::kAll) {
    BCCSKEL_ASSIGN_OR_RETURN(object.voxels, std::move(collector).Finish());
  }
  return object;
}

absl::StatusOr<CollectedLabels> CollectLabels(ImageSource& source, const ImageArguments& arguments,
                                              uint64_t min_voxels, const exec::Context& context) {
  CollectedLabels labels = {.info = source.info(), .objects = {}};
  const MaskGrid grid = GridOf(labels.info);
  BCCSKEL_ASSIGN_OR_RETURN(LabelCollector collector,
                           LabelCollector::Create(grid, {.labels = arguments.labels}));
  std::vector<uint64_t> values(grid.VoxelsPerSlice());
  for (int32_t z = 0; z < grid.nz; ++z) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source.NextSlice());
    BCCSKEL_RETURN_IF_ERROR(LabelSlice(slice, values));
    BCCSKEL_RETURN_IF_ERROR(collector.AddSlice(values, context));
  }
  BCCSKEL_ASSIGN_OR_RETURN(labels.objects, std::move(collector).Finish());
  labels.left_out = std::erase_if(labels.objects.objects, [&](const LabeledObject& object) {
    return object.voxels < min_voxels;
  });
  return labels;
}

}  // namespace bccskel::cli
