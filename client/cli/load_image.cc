#include "client/cli/load_image.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_join.h"
#include "client/cli/console.h"
#include "client/cli/load_object.h"
#include "client/export/picture/caption.h"
#include "core/exec/status_macros.h"
#include "core/import/image/open_image.h"
#include "core/mask/mask_converter.h"

namespace bccskel::cli {
namespace {

// The labels of an image. Errors: as OpenImage(), NextSlice() and LabelSlice().
absl::StatusOr<std::set<uint64_t>> LabelsIn(const std::string& path,
                                            const ImageArguments& arguments) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path, arguments.open));
  const ImageSize& size = source->info().size;
  std::vector<uint64_t> values(static_cast<size_t>(size.nx) * static_cast<size_t>(size.ny));
  std::set<uint64_t> labels;
  for (int32_t z = 0; z < size.nz; ++z) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source->NextSlice());
    BCCSKEL_RETURN_IF_ERROR(LabelSlice(slice, values));
    uint64_t last = 0;
    for (const uint64_t label : values) {
      if (label != last) labels.insert(label);
      last = label;
    }
  }
  labels.erase(0);
  return labels;
}

absl::Status NoSuchLabel(const std::string& path, const ImageArguments& arguments) {
  constexpr size_t kShown = 10;
  const std::string none =
      "no voxel has the label " +
      absl::StrJoin(std::set(arguments.labels.begin(), arguments.labels.end()), " or ");
  const absl::StatusOr<std::set<uint64_t>> there = LabelsIn(path, arguments);
  if (!there.ok()) return absl::InvalidArgumentError(none);
  if (there->empty()) return absl::InvalidArgumentError(none + ", nor any other");
  const auto end =
      std::next(there->begin(), static_cast<ptrdiff_t>(std::min(kShown, there->size())));
  return absl::InvalidArgumentError(
      none + "; " + exporting::Counted(there->size(), "label is there: ", "labels are there: ") +
      absl::StrJoin(there->begin(), end, ", ") + (there->size() > kShown ? ", ..." : ""));
}

absl::StatusOr<ImageObject> Convert(const std::string& path, const ImageArguments& arguments,
                                    KeptVoxels kept, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path, arguments.open));
  BCCSKEL_ASSIGN_OR_RETURN(ImageObject object, ConvertImage(*source, arguments, kept, context));
  if (object.image.voxels == 0 && !arguments.labels.empty()) return NoSuchLabel(path, arguments);
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

}  // namespace bccskel::cli
