#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/exec/status_macros.h"
#include "core/import/image/image_info.h"
#include "core/import/image/open_image.h"
#include "core/import/mesh/mesh_file.h"
#include "core/import/voxelize/crossings.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

using exporting::Counted;
using exporting::Text;

constexpr size_t kMostLabels = 1 << 16;

// The voxel values of an image.
struct ImageValues {
  struct Range {
    long double low;
    long double high;
  };
  VoxelType type = VoxelType::kUint8;
  std::optional<Range> range;  // none if no value is a number
  uint64_t not_numbers = 0;
  // The number of voxels of each nonzero value. None if a value is not a nonnegative whole number,
  // or beyond kMostLabels values: they are then not labels.
  std::optional<std::map<uint64_t, uint64_t>> labels;
};

class Survey {
 public:
  template <typename T>
  void Add(std::span<const T> values) {
    for (size_t begin = 0, end; begin < values.size(); begin = end) {
      end = begin + 1;
      while (end < values.size() && values[end] == values[begin]) ++end;
      AddRun(values[begin], end - begin);
    }
  }

  ImageValues Take(VoxelType type) && {
    values_.type = type;
    if (are_labels_) values_.labels.emplace(counts_.begin(), counts_.end());
    return std::move(values_);
  }

 private:
  template <typename T>
  void AddRun(T value, uint64_t count) {
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isnan(value)) {
        values_.not_numbers += count;
        return;
      }
    }
    const auto number = static_cast<long double>(value);
    if (!values_.range.has_value()) values_.range = {number, number};
    values_.range->low = std::min(values_.range->low, number);
    values_.range->high = std::max(values_.range->high, number);
    if (!are_labels_ || value == T{0}) return;
    // 2^64 is the first value that is too large.
    are_labels_ = number > 0 && number < std::ldexp(1.0L, 64) && std::floor(number) == number &&
                  counts_.size() <= kMostLabels;
    if (are_labels_) counts_[static_cast<uint64_t>(value)] += count;
  }

  ImageValues values_;
  std::unordered_map<uint64_t, uint64_t> counts_;
  bool are_labels_ = true;
};

absl::StatusOr<ImageValues> Read(const std::string& path, const ImageOptions& options,
                                 const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path, options));
  Survey survey;
  for (int32_t z = 0; z < source->info().size.nz; ++z) {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source->NextSlice());
    std::visit([&](const auto values) { survey.Add(values); }, slice.values);
  }
  return std::move(survey).Take(source->info().type);
}

// In the shortest form from which its own type reads the same value.
std::string NumberText(long double value, VoxelType type) {
  Text text;
  if (type == VoxelType::kFloat32) {
    text.Add(static_cast<float>(value));
  } else if (type == VoxelType::kFloat64) {
    text.Add(static_cast<double>(value));
  } else if (value < 0) {
    text.Add(static_cast<int64_t>(value));
  } else {
    text.Add(static_cast<uint64_t>(value));
  }
  return std::move(text).Take();
}

// JSON has no infinities: they are strings.
std::string NumberJson(long double value, VoxelType type) {
  return std::isfinite(value) ? NumberText(value, type) : '"' + NumberText(value, type) + '"';
}

// Errors: as OpenImage() and NextSlice(), with the path; CANCELLED.
absl::StatusOr<ImageValues> ReadImageValues(const std::string& path, const ImageOptions& options,
                                            const exec::Context& context) {
  absl::StatusOr<ImageValues> values = Read(path, options, context);
  if (!values.ok()) return WithPath(values.status(), path);
  return values;
}

// "values:      0 to 3\nlabels:      1 (80 voxels), 3 (12 voxels)\n"; and the same as members of a
// JSON object.
std::string ValuesText(const ImageValues& values) {
  constexpr size_t kShown = 10;
  Text text;
  text.Add("values:      ");
  if (values.range.has_value()) {
    text.Add(NumberText(values.range->low, values.type), " to ",
             NumberText(values.range->high, values.type));
  } else {
    text.Add("none");
  }
  if (values.not_numbers > 0) {
    text.Add(", ", Counted(values.not_numbers, "voxel is NaN", "voxels are NaN"));
  }
  if (!values.labels.has_value()) return std::move(text.Add('\n')).Take();
  text.Add("\nlabels:      ", values.labels->empty() ? "none" : "");
  size_t shown = 0;
  for (const auto& [label, voxels] : *values.labels) {
    text.Add(shown == 0 ? "" : ", ");
    if (shown++ == kShown) {
      text.Add("... (", exporting::GroupedDigits(values.labels->size()), " in all)");
      break;
    }
    text.Add(label, " (", Counted(voxels, "voxel", "voxels"), ')');
  }
  return std::move(text.Add('\n')).Take();
}

std::string ValuesJson(const ImageValues& values) {
  Text text;
  if (values.range.has_value()) {
    text.Add("\"low\":", NumberJson(values.range->low, values.type),
             ",\"high\":", NumberJson(values.range->high, values.type), ',');
  }
  text.Add("\"not_numbers\":", values.not_numbers);
  if (!values.labels.has_value()) return std::move(text).Take();
  text.Add(",\"labels\":[");
  std::string_view before;
  for (const auto& [label, voxels] : *values.labels) {
    text.Add(before, "{\"label\":", label, ",\"voxels\":", voxels, '}');
    before = ",";
  }
  return std::move(text.Add(']')).Take();
}

std::string Wrapped(const InfoArguments& arguments, const std::string& kind,
                    const std::string& json) {
  return "{\"file\":" + JsonString(arguments.file) + ",\"kind\":\"" + kind + "\",\"" + kind +
         "\":" + json + "}\n";
}

ExitCode AboutMesh(const InfoArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<TriangleMesh> mesh = ReadMeshFile(arguments.file);
  if (!mesh.ok()) return Fail(mesh.status());
  exec::Context context;
  context.stop = stop;
  const Surface surface = PrepareSurface(*mesh);
  const absl::StatusOr<CrossingCount> crossings = CountCrossings(surface, context);
  if (!crossings.ok()) return Fail(crossings.status());
  const uint64_t count = crossings->total();
  if (arguments.common.summary == SummaryStyle::kText) {
    return Print(MeshText(surface.report, count));
  }
  return Print(Wrapped(arguments, "mesh", MeshJson(surface.report, count)));
}

ExitCode AboutImage(const InfoArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<ImageObject> object =
      ConvertImageFile(arguments.file, arguments.image, KeptVoxels::kNone, team.context());
  if (!object.ok()) return Fail(object.status());
  const absl::StatusOr<ImageValues> values =
      ReadImageValues(arguments.file, arguments.image.open, team.context());
  if (!values.ok()) return Fail(values.status());
  if (arguments.common.summary == SummaryStyle::kText) {
    return Print(ImageText(object->image) + ValuesText(*values));
  }
  return Print(Wrapped(arguments, "image",
                       ImageJson(object->image, ",\"values\":{" + ValuesJson(*values) + "}")));
}

ExitCode AboutVolume(const InfoArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<Volume> volume = ReadVolumeFile(arguments.file, {}, team.context());
  if (!volume.ok()) return Fail(volume.status());
  const absl::StatusOr<BettiNumbers> betti = CountBettiNumbers(*volume, team.context());
  if (!betti.ok()) return Fail(betti.status());
  if (arguments.common.summary == SummaryStyle::kText) return Print(VolumeText(*volume, *betti));
  return Print(Wrapped(arguments, "volume", VolumeJson(*volume, *betti)));
}

}  // namespace

void AddInfo(CLI::App& command, InfoArguments& arguments) {
  AddInput(command, "FILE", arguments.file, "Mesh, volume or image file");
  AddImage(command, arguments.image);
  AddCommonHere(command, arguments.common);
}

ExitCode Run(const InfoArguments& arguments, const std::stop_token& stop) {
  const ProgressBar bar(arguments.common.progress);
  bar.Begin("reading", arguments.file);
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.file, arguments.image);
  if (!kind.ok()) return Fail(kind.status());
  if (*kind == InputKind::kImage) return AboutImage(arguments, stop);
  return *kind == InputKind::kMesh ? AboutMesh(arguments, stop) : AboutVolume(arguments, stop);
}

}  // namespace bccskel::cli
