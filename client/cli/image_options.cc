#include "client/cli/image_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"
#include "client/cli/option_values.h"
#include "core/exec/status_macros.h"
#include "core/lattice/length_unit.h"
#include "core/mask/mask_sampler.h"

namespace bccskel::cli {

void AddGrid(CLI::App& command, VoxelizeOptions& grid) {
  CLI::Option* points = AddCount<uint64_t>(
      command, "--points", [&grid](uint64_t number) { grid.points = number; },
      "Number of lattice points inside the solid (default 850000)", 1, grid.max_points);
  command.add_option("--spacing", grid.spacing, "Edge of the cubic cell, in the mesh's unit")
      ->check(Positive())
      ->excludes(points)
      ->option_text("LENGTH");
  AddChoice<FillRule>(
      command, "--fill", grid.fill, "What is inside a mesh (default auto)",
      {{"auto", FillRule::kAuto}, {"parity", FillRule::kParity}, {"winding", FillRule::kWinding}});
  AddChoice<ThinParts>(command, "--thin-parts", grid.thin_parts,
                       "Parts of a mesh thinner than two lattice units: keep (default) adds the "
                       "points that leave them whole, sample adds none",
                       {{"keep", ThinParts::kKeep}, {"sample", ThinParts::kSample}});
  AddChoice<LatticeAxes>(command, "--lattice-axes", grid.axes,
                         "Axes of a mesh's lattice: the shape's own (default), so that the result "
                         "does not depend on the pose, or the world's",
                         {{"shape", LatticeAxes::kShape}, {"world", LatticeAxes::kWorld}});
}

namespace {

constexpr const char* kGroup = "Images";

// "7" or "3-9". `range` is the option that takes other values.
void ReadLabels(const std::string& given, const std::string& range, std::vector<uint64_t>& labels) {
  constexpr uint64_t kMostOfRange = 1'000'000;
  const auto refuse = [&](const std::string& why) {
    throw CLI::ValidationError("--label " + given + ": " + why);
  };
  const size_t dash = given.find('-', 1);
  const std::optional<uint64_t> first = ParseCount(given.substr(0, dash));
  const auto last = dash == given.npos ? first : ParseCount(given.substr(dash + 1));
  if (!first.has_value() || !last.has_value()) {
    refuse(std::string("must be a whole number from 1 on or a range, such as 3,7 or 1-85") +
           (given.starts_with('-') ? "; " + range + " takes negative values" : ""));
  }
  uint64_t low = *first;
  const uint64_t high = *last;
  if (low > high) refuse("the first label is above the last");
  if (high == 0) refuse("0 is the background, whose voxels only " + range + " 0,0 selects");
  low = std::max<uint64_t>(low, 1);
  if (high - low >= kMostOfRange) {
    refuse("is more than " + std::to_string(kMostOfRange) + " labels; " + range + " takes more");
  }
  for (uint64_t label = low; label < high; ++label) labels.push_back(label);
  labels.push_back(high);
}

CLI::Option* AddLabelList(CLI::App& command, ImageArguments& arguments, const char* description) {
  const auto read = [&command, &arguments](const std::vector<std::string>& given) {
    const bool here = command.get_option_no_throw("--range") != nullptr;
    const std::string range = here ? "--range" : "skeletonize --range";
    for (const std::string& labels : given) ReadLabels(labels, range, arguments.labels);
  };
  return command
      .add_option_function<std::vector<std::string>>("--label,--labels", read, description)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->option_text("LIST");
}

void AddForeground(CLI::App& command, ImageArguments& arguments) {
  CLI::Option* labels =
      AddLabelList(command, arguments,
                   "Voxels of these labels, such as 3,7 or 1-85; ranges leave out 0, the "
                   "background");
  CLI::Option* range =
      command
          .add_option("--range", arguments.range,
                      "Voxels from LOW to HIGH, both included; either may be omitted")
          ->option_text("LOW,HIGH");
  CLI::Option* threshold =
      command.add_option("--threshold", arguments.threshold, "Voxels of at least this value")
          ->check(Exact())
          ->option_text("T");
  CLI::Option* below =
      command.add_option("--below", arguments.below, "Voxels below this value (level sets: 0)")
          ->check(Exact())
          ->option_text("T");
  const std::vector<CLI::Option*> rules = {labels, range, threshold, below};
  for (CLI::Option* rule : rules) {
    for (CLI::Option* other : rules) {
      if (rule != other) rule->excludes(other);
    }
  }
  command.add_flag("--invert", arguments.invert, "Swap object and background");
}

void AddConversion(CLI::App& command, ImageArguments& arguments) {
  AddChoice<MaskAdjacency>(command, "--adjacency", arguments.mask.adjacency,
                           "Adjacency of voxels in the object and in the background (default 26,6)",
                           {{"26,6", MaskAdjacency::k26}, {"6,26", MaskAdjacency::k6}});
  CLI::Option* points = AddChoice<VoxelPoints>(
      command, "--voxel-points", arguments.mask.points,
      "Lattice points per voxel of the exact conversion (default 2); 16 makes "
      "finer curves",
      {{"2", VoxelPoints::kTwo}, {"16", VoxelPoints::kSixteen}});
  using Weights = std::optional<MaskWeights>;  // none: exact
  CLI::Option* sampling = AddChoice<Weights>(
      command, "--sampling",
      [&arguments](Weights weights) {
        if (weights.has_value()) arguments.mask.sampling.emplace().weights = *weights;
      },
      "How voxels become lattice points; only exact (default) keeps the topology",
      {{"exact", std::nullopt},
       {"nearest", MaskWeights::kNearest},
       {"trilinear", MaskWeights::kTrilinear}});
  points->excludes(sampling);
  command
      .add_option_function<double>(
          "--density",
          [&arguments](double points) {
            if (!arguments.mask.sampling.has_value()) {
              throw CLI::ValidationError(
                  "--density needs --sampling nearest or --sampling trilinear");
            }
            arguments.mask.sampling->points_per_voxel = points;
          },
          "Lattice points per voxel of --sampling nearest or trilinear (default 2)")
      ->needs(sampling)
      ->check(Within(kMinPointsPerVoxel, kMaxPointsPerVoxel))
      ->option_text("X");
}

RawLayout& RawOf(ImageArguments& arguments) {
  if (!arguments.open.raw.has_value()) arguments.open.raw.emplace();
  return *arguments.open.raw;
}

void AddRaw(CLI::App& command, ImageArguments& arguments) {
  CLI::Option* size = command
                          .add_option_function<std::vector<int64_t>>(
                              "--raw-size",
                              [&arguments](const std::vector<int64_t>& n) {
                                RawOf(arguments).size = {n[0], n[1], n[2]};
                              },
                              "Read raw voxels, this many along each axis")
                          ->delimiter(',')
                          ->expected(3)
                          ->option_text("X,Y,Z");
  command
      .add_option_function<std::string>(
          "--raw-type",
          [&arguments](const std::string& name) {
            const absl::StatusOr<VoxelType> type = ParseVoxelType(name);
            if (!type.ok()) throw CLI::ValidationError(std::string(type.status().message()));
            RawOf(arguments).type = *type;
          },
          "Type of raw voxels: u8 (default), i8, u16, i16, u32, i32, u64, i64, f32 or f64")
      ->needs(size)
      ->option_text("TYPE");
  AddChoice<std::endian>(command, "--raw-order",
                         [&arguments](std::endian order) { RawOf(arguments).byte_order = order; },
                         "Byte order of raw voxels (default little)",
                         {{"little", std::endian::little}, {"big", std::endian::big}})
      ->needs(size);
  AddCount<uint64_t>(
      command, "--raw-header",
      [&arguments](uint64_t bytes) { RawOf(arguments).header_bytes = bytes; },
      "Bytes before the raw voxels (default 0)")
      ->needs(size);
}

// An end of a range; `open` if the text is empty.
absl::StatusOr<double> EndOf(std::string_view text, double open) {
  if (text.empty()) return open;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string inexact = WhyInexact(std::string(text));
  if (!inexact.empty()) return absl::InvalidArgumentError("--range: " + inexact);
  if (error == std::errc() && end == text.data() + text.size()) return value;
  return absl::InvalidArgumentError("--range: '" + std::string(text) + "' is not a number");
}

// Errors: CLI::ValidationError.
std::array<double, 3> VoxelSizeOf(const std::string& given) {
  // Their squares and the sizes of images in such units fit a float, in which some formats store
  // coordinates.
  constexpr double kLeast = 1e-15, kMost = 1e15;
  const std::vector<std::string> words = absl::StrSplit(given, ',');
  const bool spaces = absl::StripAsciiWhitespace(words.front()).find(' ') != std::string::npos;
  if (spaces || (words.size() != 1 && words.size() != 3)) {
    throw CLI::ValidationError("--voxel-size " + given +
                               ": must be one number, or three separated by commas");
  }
  std::array<double, 3> spacing = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    std::string word = words[axis % words.size()];
    const std::string wrong = Within(kLeast, kMost)(word);
    if (!wrong.empty() || !absl::SimpleAtod(word, &spacing[axis])) {
      throw CLI::ValidationError("--voxel-size: " + wrong);
    }
  }
  return spacing;
}

absl::StatusOr<ForegroundRule> RangeOf(std::string_view text) {
  const size_t comma = text.find(',');
  if (comma == text.npos || text.size() == 1) {
    return absl::InvalidArgumentError(
        "--range " + std::string(text) +
        ": needs LOW,HIGH, such as 5,5 for one value or 5, for all from it on");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const double low, EndOf(text.substr(0, comma), -ForegroundRule::kOpen));
  BCCSKEL_ASSIGN_OR_RETURN(const double high, EndOf(text.substr(comma + 1), ForegroundRule::kOpen));
  return ForegroundRule::Range(low, high);
}

absl::StatusOr<ForegroundRule> UprightRule(const ImageArguments& arguments) {
  if (!arguments.labels.empty()) return ForegroundRule::Labels(arguments.labels);
  if (!arguments.range.empty()) return RangeOf(arguments.range);
  if (arguments.threshold.has_value()) return ForegroundRule::From(*arguments.threshold);
  if (arguments.below.has_value()) return ForegroundRule::Below(*arguments.below);
  return ForegroundRule::NonZero();
}

}  // namespace

void AddUnit(CLI::App& command, std::optional<std::string>& unit, const char* description) {
  const auto read = [&unit](const std::string& given) {
    if (!NanometersOf(given).has_value()) {
      throw CLI::ValidationError("--unit " + given +
                                 ": must be a unit of length, such as nm, um, mm, cm or m");
    }
    unit = UnitNamed(given);
  };
  command.add_option_function<std::string>("--unit", read, description)->option_text("UNIT");
}

void AddImageLayout(CLI::App& command, ImageArguments& arguments) {
  command
      .add_option_function<std::string>(
          "--voxel-size",
          [&arguments](const std::string& given) { arguments.open.spacing = VoxelSizeOf(given); },
          "Spacing of the voxels, instead of the one in the file: one number for cubes, or three")
      ->option_text("X[,Y,Z]");
  AddUnit(command, arguments.open.unit,
          "Unit of lengths, such as um, instead of the one in the file");
  const auto choose = [&command](const char* name, std::optional<int64_t>& chosen,
                                 const char* description) {
    AddCount<uint32_t>(
        command, name, [&chosen](uint32_t number) { chosen = number; }, description);
  };
  choose("--channel", arguments.open.channel,
         "Channel, from 0, of a TIFF file or OME-Zarr folder that has several");
  choose("--time", arguments.open.time,
         "Time point, from 0, of a TIFF file or OME-Zarr folder that has several");
  choose("--level", arguments.open.level,
         "Resolution of an OME-Zarr or precomputed folder; 0 (default) is the finest");
  command
      .add_option("--series", arguments.open.series,
                  "Number or unique identifier of a series, of a DICOM folder that has several")
      ->option_text("SERIES");
  command
      .add_option("--array", arguments.open.array,
                  "Name of an array, of an .npz file that has several")
      ->option_text("NAME");
  AddRaw(command, arguments);
}

void AddMaskOptions(CLI::App& command, ImageArguments& arguments) {
  AddForeground(command, arguments);
  AddConversion(command, arguments);
}

void AddLabelOptions(CLI::App& command, ImageArguments& arguments) {
  AddLabelList(command, arguments, "Only these labels, such as 3,7 or 1-85");
  AddConversion(command, arguments);
}

void AddImage(CLI::App& command, ImageArguments& arguments) {
  CLI::Option_group& group = *command.add_option_group(kGroup, "How an image becomes an object");
  AddMaskOptions(group, arguments);
  AddImageLayout(group, arguments);
  group.parse_complete_callback([&group, &arguments] { arguments.given = group.count_all() > 0; });
}

void AddLabelImage(CLI::App& command, ImageArguments& arguments) {
  AddLabelOptions(command, arguments);
  AddImageLayout(command, arguments);
}

void AddSkeletonImages(CLI::App& command, SkeletonImages& images) {
  command
      .add_option("--branch-image", images.branches,
                  "Write an image with the nearest branch of each voxel of the object (.nrrd)")
      ->option_text("FILE");
  command
      .add_option("--curve-image", images.curves,
                  "Write an image with the voxels that the curves run through (.nrrd)")
      ->option_text("FILE");
}

absl::StatusOr<ForegroundRule> ForegroundOf(const ImageArguments& arguments) {
  BCCSKEL_ASSIGN_OR_RETURN(ForegroundRule rule, UprightRule(arguments));
  return arguments.invert ? rule.Inverted() : rule;
}

}  // namespace bccskel::cli
