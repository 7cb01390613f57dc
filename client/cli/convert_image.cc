#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/image_options.h"
#include "core/exec/read_ahead.h"
#include "core/exec/status_macros.h"
#include "core/import/image/gray_levels.h"
#include "core/labels/label_collector.h"
#include "core/mask/mask_converter.h"

// Converts images by the options of image_options.cc.

namespace bccskel::cli {

MaskGrid GridOf(const ImageInfo& info) {
  return {info.size.nx, info.size.ny, info.size.nz, info.placement};
}

namespace {

// Reads an image, several small slices at a time. `take(slice, room)` converts a slice into
// `slice_size` values, which `use(values)` receives in order.
template <typename Take, typename Use>
absl::Status ReadSlices(ImageSource& source, size_t slice_size, const exec::Context& context,
                        Take take, Use use) {
  using Room = std::vector<uint64_t>;
  constexpr size_t kVoxelsAtOnce = size_t{1} << 18;
  const ImageSize size = source.info().size;
  const auto slices = static_cast<size_t>(size.nz);
  const size_t at_once = std::clamp<size_t>(kVoxelsAtOnce / size.SliceVoxels(), 1, slices);
  const auto each = [&](size_t part, Room& room, auto work) -> absl::Status {
    const size_t count = std::min(at_once, slices - part * at_once);
    room.resize(at_once * slice_size);
    for (size_t n = 0; n < count; ++n) {
      BCCSKEL_RETURN_IF_ERROR(work(std::span(room).subspan(n * slice_size, slice_size)));
    }
    return absl::OkStatus();
  };
  const auto read = [&](std::span<uint64_t> room) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source.NextSlice());
    return take(slice, room);
  };
  return exec::ReadAhead<Room>(
      context, (slices + at_once - 1) / at_once,
      [&](size_t part, Room& room) { return each(part, room, read); },
      [&](size_t part, Room& room) { return each(part, room, use); });
}

// Whether the object is everything but 0 because nothing else was requested.
bool IsPlain(const ImageArguments& arguments) {
  return arguments.labels.empty() && arguments.range.empty() && !arguments.threshold.has_value() &&
         !arguments.below.has_value() && !arguments.invert;
}

std::string WarningOf(const GrayLevels& levels) {
  const std::optional<double> threshold = levels.Threshold();
  const bool signs = levels.HasBothSigns();
  if (!threshold.has_value() && !signs) return "";
  std::string warning = absl::StrCat("the values look like ",
                                     threshold.has_value() ? "gray levels" : "those of a level set",
                                     ", and all but 0 are taken for the object; ");
  if (threshold.has_value()) {
    absl::StrAppendFormat(&warning, "--threshold %g (Otsu's) or --range selects it", *threshold);
  }
  if (signs) {
    absl::StrAppend(&warning, threshold.has_value() ? ", " : "",
                    "--below 0 selects the inside of a level set");
  }
  return warning;
}

std::vector<std::string> WarningsOf(const ImageInfo& info, const ImageArguments& arguments,
                                    const GrayLevels& levels, uint64_t object,
                                    uint64_t not_numbers) {
  std::vector<std::string> warnings;
  const std::string gray = WarningOf(levels);
  if (!gray.empty()) {
    warnings.push_back(gray);
  } else if (levels.HasSeveralLabels()) {
    warnings.emplace_back(
        "several labels are taken for one object; --label selects some, and the command labels "
        "takes each by itself");
  } else if (object == info.size.Voxels()) {
    // A threshold excludes labels, and does not help an inverted object.
    const bool by_value = arguments.labels.empty() && !arguments.invert;
    warnings.push_back(std::string("the object fills the whole image") +
                       (levels.HasOneValue()
                            ? ", whose voxels seem to have one value: check the image"
                        : by_value ? "; --threshold or --below selects a part of it"
                                   : ""));
  }
  if (not_numbers > 0 && not_numbers < info.size.Voxels()) {
    warnings.push_back(NanWarning(not_numbers));
  }
  return warnings;
}

}  // namespace

std::string NanWarning(uint64_t voxels) {
  return absl::StrCat(voxels, voxels == 1 ? " voxel is" : " voxels are",
                      " NaN, which counts as background");
}

absl::StatusOr<ImageObject> ConvertImage(ImageSource& source, const ImageArguments& arguments,
                                         KeptVoxels kept, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const ForegroundRule rule, ForegroundOf(arguments));
  const MaskGrid grid = GridOf(source.info());
  BCCSKEL_ASSIGN_OR_RETURN(MaskConverter converter, MaskConverter::Create(grid, arguments.mask));
  BCCSKEL_ASSIGN_OR_RETURN(LabelCollector collector, LabelCollector::Create(grid, {}));
  GrayLevels levels(source.info().size);
  const bool plain = IsPlain(arguments);
  uint64_t not_numbers = 0;
  BCCSKEL_RETURN_IF_ERROR(ReadSlices(
      source, grid.WordsPerSlice(), context,
      [&](const ImageSlice& slice, std::span<uint64_t> words) {
        if (plain) levels.Add(slice);
        not_numbers += CountNotNumbers(slice);
        ForegroundSlice(slice, rule, words);
        return absl::OkStatus();
      },
      [&](std::span<const uint64_t> words) {
        BCCSKEL_RETURN_IF_ERROR(converter.AddSlice(words, context));
        return kept == KeptVoxels::kNone ? absl::OkStatus()
                                         : collector.AddMaskSlice(words, context);
      }));
  BCCSKEL_ASSIGN_OR_RETURN(ConvertedMask mask, std::move(converter).Finish());
  ImageObject object = {std::move(mask.volume),
                        {source.info(), mask.voxels, mask.mask,
                         WarningsOf(source.info(), arguments, levels, mask.voxels, not_numbers)}};
  if (kept == KeptVoxels::kAll) {
    BCCSKEL_ASSIGN_OR_RETURN(object.voxels, std::move(collector).Finish());
  }
  return object;
}

namespace {

// The error of a slice whose values are no labels, with the way to read gray levels. Reads the rest
// of the image.
absl::Status NotLabels(const absl::Status& error, ImageSource& source, int32_t slices_left,
                       GrayLevels& levels) {
  for (; slices_left > 0; --slices_left) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source.NextSlice());
    levels.Add(slice);
  }
  const std::optional<double> threshold = levels.Threshold();
  return absl::InvalidArgumentError(
      absl::StrCat(error.message(), "; of gray levels, bccskel skeletonize --threshold ",
                   threshold.has_value() ? absl::StrFormat("%g (Otsu's) ", *threshold) : "",
                   "takes the brighter voxels for one object",
                   levels.HasBothSigns() ? "; --below 0 takes the inside of a level set" : ""));
}

}  // namespace

absl::StatusOr<CollectedLabels> CollectLabels(ImageSource& source, const ImageArguments& arguments,
                                              uint64_t min_voxels, const exec::Context& context) {
  CollectedLabels labels = {.info = source.info(), .objects = {}};
  const MaskGrid grid = GridOf(labels.info);
  BCCSKEL_ASSIGN_OR_RETURN(LabelCollector collector,
                           LabelCollector::Create(grid, {.labels = arguments.labels}));
  GrayLevels levels(labels.info.size);
  int32_t slices_left = labels.info.size.nz;
  BCCSKEL_RETURN_IF_ERROR(ReadSlices(
      source, grid.VoxelsPerSlice(), context,
      [&](const ImageSlice& slice, std::span<uint64_t> values) {
        --slices_left;
        levels.Add(slice);
        labels.not_numbers += CountNotNumbers(slice);
        const absl::Status taken = LabelSlice(slice, values);
        return taken.ok() ? taken : NotLabels(taken, source, slices_left, levels);
      },
      [&](std::span<const uint64_t> values) { return collector.AddSlice(values, context); }));
  BCCSKEL_ASSIGN_OR_RETURN(labels.objects, std::move(collector).Finish());
  if (arguments.labels.empty()) labels.gray_threshold = levels.Threshold();
  labels.left_out = std::erase_if(labels.objects.objects, [&](const LabeledObject& object) {
    return object.voxels < min_voxels;
  });
  return labels;
}

namespace {

// Errors: as NextSlice() and LabelSlice().
absl::StatusOr<std::set<uint64_t>> LabelsIn(ImageSource& source) {
  const ImageSize& size = source.info().size;
  std::vector<uint64_t> values(static_cast<size_t>(size.nx) * static_cast<size_t>(size.ny));
  std::set<uint64_t> labels;
  for (int32_t z = 0; z < size.nz; ++z) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source.NextSlice());
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

}  // namespace

absl::Status NoSuchLabel(const std::vector<uint64_t>& labels, ImageSource& source) {
  constexpr size_t kShown = 10;
  const std::string none =
      "no voxel has the label " + absl::StrJoin(std::set(labels.begin(), labels.end()), " or ");
  const absl::StatusOr<std::set<uint64_t>> there = LabelsIn(source);
  if (!there.ok()) return absl::InvalidArgumentError(none);
  if (there->empty()) return absl::InvalidArgumentError(none + ", nor any other");
  const auto end =
      std::next(there->begin(), static_cast<ptrdiff_t>(std::min(kShown, there->size())));
  return absl::InvalidArgumentError(absl::StrCat(
      none, "; the image has ", there->size(), there->size() == 1 ? " label: " : " labels: ",
      absl::StrJoin(there->begin(), end, ", "), there->size() > kShown ? ", ..." : ""));
}

}  // namespace bccskel::cli
