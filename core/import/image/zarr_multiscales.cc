// The attributes of an OME-Zarr group.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/axis_units.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_choice.h"
#include "core/import/image/json_metadata.h"
#include "core/import/image/zarr_metadata.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

// Axes are objects since version 0.4, names in 0.3, and always t, c, z, y, x before.
absl::StatusOr<std::string> NameOf(const Json& axis) {
  return TextOf("an axis's name", axis.is_object() ? MemberOf(axis, "name") : axis);
}

absl::Status ReadAxes(const Json& axes, ZarrLevel& level) {
  if (axes.is_null()) {
    level.axes = {'t', 'c', 'z', 'y', 'x'};
    return absl::OkStatus();
  }
  if (!axes.is_array() || axes.empty()) return BadValue("axes", axes, "is not a list of axes");
  for (const Json& axis : axes) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::string name, NameOf(axis));
    const bool known = name.size() == 1 && std::string_view("tczyx").find(name[0]) != name.npos;
    if (!known || std::ranges::count(level.axes, name[0]) > 0) {
      return absl::UnimplementedError(
          BadField("axis", name, "is none of t, c, z, y, x, or there twice").message());
    }
    level.axes.push_back(name[0]);
  }
  return absl::OkStatus();
}

// The last step, after all transformations.
absl::Status ConvertToOneUnit(const Json& axes, ZarrLevel& level) {
  constexpr std::string_view kSpace = "xyz";
  std::array<std::optional<std::string>, 3> units;
  for (size_t n = 0; axes.is_array() && n < axes.size(); ++n) {
    const size_t axis = kSpace.find(level.axes[n]);
    if (axis == kSpace.npos) continue;
    const Json& unit = MemberOf(axes[n], "unit");
    units[axis] = unit.is_string() ? unit.get<std::string>() : "";
  }
  BCCSKEL_ASSIGN_OR_RETURN(const CommonUnit common, CommonUnitOf(units));
  level.unit = common.unit;
  for (size_t n = 0; n < level.axes.size(); ++n) {
    const size_t axis = kSpace.find(level.axes[n]);
    if (axis == kSpace.npos) continue;
    level.scale[n] *= common.factors[axis];
    level.translation[n] *= common.factors[axis];
  }
  return absl::OkStatus();
}

// What is done to the coordinates that `level` gives so far.
absl::Status Apply(const Json& transformations, ZarrLevel& level) {
  if (transformations.is_null()) return absl::OkStatus();
  if (!transformations.is_array()) {
    return BadValue("coordinateTransformations", transformations, "is not a list");
  }
  for (const Json& step : transformations) {
    const Json& type = MemberOf(step, "type");
    if (type == "identity") continue;
    if ((type != "scale" && type != "translation") || !MemberOf(step, "path").is_null()) {
      return absl::UnimplementedError(
          BadValue("transformation", step, "is neither a scale nor a translation in numbers")
              .message());
    }
    const auto name = type.get<std::string>();
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> numbers,
                             NumbersOf(name, MemberOf(step, name)));
    if (numbers.size() != level.axes.size()) {
      return absl::InvalidArgumentError(absl::StrFormat("a %s has %d numbers for %d axes", name,
                                                        numbers.size(), level.axes.size()));
    }
    for (size_t n = 0; n < numbers.size(); ++n) {
      if (type == "scale") level.scale[n] *= numbers[n];
      level.translation[n] =
          type == "scale" ? level.translation[n] * numbers[n] : level.translation[n] + numbers[n];
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ZarrLevel> ParseMultiscales(const Json& attributes, const ImageOptions& options) {
  const Json& images = MemberOf(attributes, "multiscales");
  if (!images.is_array() || images.empty()) {
    return absl::InvalidArgumentError(
        "the Zarr group states no multiscales: name the folder of one image or array in it, such "
        "as FOLDER/0");
  }
  const Json& image = images[0];
  // Of the image, since 0.5 of the group.
  const Json& own = MemberOf(image, "version");
  const Json& version = own.is_null() ? MemberOf(attributes, "version") : own;
  constexpr std::array<const char*, 5> kVersions = {"0.1", "0.2", "0.3", "0.4", "0.5"};
  if (!version.is_null() && std::ranges::find(kVersions, version) == kVersions.end()) {
    return absl::UnimplementedError(
        BadValue("OME-Zarr version", version, "is not supported; 0.1 to 0.5 are").message());
  }
  const Json& datasets = MemberOf(image, "datasets");
  if (!datasets.is_array() || datasets.empty()) {
    return BadValue("datasets", datasets, "is not a list of levels");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const int64_t chosen,
                           ChosenLevel(static_cast<int64_t>(datasets.size()), options));
  const Json& dataset = datasets[static_cast<size_t>(chosen)];
  ZarrLevel level;
  BCCSKEL_ASSIGN_OR_RETURN(level.path, TextOf("path", MemberOf(dataset, "path")));
  if (!IsBelowFolder(level.path)) {
    return BadField("path", level.path, "is not that of an array in the folder");
  }
  BCCSKEL_RETURN_IF_ERROR(ReadAxes(MemberOf(image, "axes"), level));
  level.scale.assign(level.axes.size(), 1);
  level.translation.assign(level.axes.size(), 0);
  BCCSKEL_RETURN_IF_ERROR(Apply(MemberOf(dataset, "coordinateTransformations"), level));
  BCCSKEL_RETURN_IF_ERROR(Apply(MemberOf(image, "coordinateTransformations"), level));
  BCCSKEL_RETURN_IF_ERROR(ConvertToOneUnit(MemberOf(image, "axes"), level));
  return level;
}

}  // namespace bccskel
