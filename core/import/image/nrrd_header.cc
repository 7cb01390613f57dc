// NRRD, by teem's definition of the format, versions 1 to 5.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/axis_units.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"

namespace bccskel {
namespace {

struct TypeNames {
  VoxelType type;
  std::string_view names;  // between bars
};
constexpr std::array<TypeNames, 10> kNrrdTypes = {{
    {VoxelType::kInt8, "|signed char|int8|int8_t|"},
    {VoxelType::kUint8, "|uchar|unsigned char|uint8|uint8_t|"},
    {VoxelType::kInt16, "|short|short int|signed short|signed short int|int16|int16_t|"},
    {VoxelType::kUint16, "|ushort|unsigned short|unsigned short int|uint16|uint16_t|"},
    {VoxelType::kInt32, "|int|signed int|int32|int32_t|"},
    {VoxelType::kUint32, "|uint|unsigned int|uint32|uint32_t|"},
    {VoxelType::kInt64,
     "|longlong|long long|long long int|signed long long|signed long long int|int64|int64_t|"},
    {VoxelType::kUint64, "|ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t|"},
    {VoxelType::kFloat32, "|float|"},
    {VoxelType::kFloat64, "|double|"},
}};

struct SpaceName {
  std::string_view name;
  std::string_view axes;
};
constexpr std::array<SpaceName, 6> kSpaces = {{
    {"right-anterior-superior", "RAS"},
    {"ras", "RAS"},
    {"left-anterior-superior", "LAS"},
    {"las", "LAS"},
    {"left-posterior-superior", "LPS"},
    {"lps", "LPS"},
}};

absl::StatusOr<VoxelType> NrrdTypeOf(const HeaderFields& fields) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view name, fields.Require({"type"}));
  const std::string wanted = absl::StrFormat("|%s|", LowerCase(name));
  for (const TypeNames& entry : kNrrdTypes) {
    if (entry.names.find(wanted) != entry.names.npos) return entry.type;
  }
  return BadField("type", name, "is not a type of numbers");
}

absl::StatusOr<std::endian> NrrdByteOrderOf(const HeaderFields& fields, VoxelType type) {
  if (VoxelBytes(type) == 1) return std::endian::little;
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view order, fields.Require({"endian"}));
  const std::string name = LowerCase(order);
  if (name == "little") return std::endian::little;
  if (name == "big") return std::endian::big;
  return BadField("endian", order, "is neither little nor big");
}

absl::StatusOr<Compression> NrrdCompressionOf(const HeaderFields& fields) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view encoding, fields.Require({"encoding"}));
  const std::string name = LowerCase(encoding);
  if (name == "raw") return Compression::kNone;
  if (name == "gzip" || name == "gz") return Compression::kDeflate;
  for (const std::string_view known : {"ascii", "text", "txt", "hex", "bzip2", "bz2", "zrl"}) {
    if (name != known) continue;
    return absl::UnimplementedError(
        absl::StrFormat("encoding '%s' is not supported; raw and gzip are", name));
  }
  return BadField("encoding", encoding, "is neither raw nor gzip");
}

absl::StatusOr<std::vector<int64_t>> NrrdSizesOf(const HeaderFields& fields) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view dimension, fields.Require({"dimension"}));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view text, fields.Require({"sizes"}));
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<int64_t> sizes, ParseNumbers<int64_t>("sizes", text));
  if (ParseNumber<size_t>(dimension) != sizes.size()) {
    return BadField("dimension", dimension, "is not the number of sizes");
  }
  return sizes;
}

// "(1,0,0)" as a point; in a plane, the third coordinate is 0.
absl::StatusOr<WorldPoint> VectorOf(std::string_view field, std::string_view text) {
  if (!text.starts_with('(') || !text.ends_with(')'))
    return BadField(field, text, "is not a vector");
  WorldPoint point = {0, 0, 0};
  const std::vector<std::string_view> words = Words(text.substr(1, text.size() - 2), ",");
  if (words.empty() || words.size() > 3) return BadField(field, text, "has not 1 to 3 coordinates");
  for (size_t n = 0; n < words.size(); ++n) {
    const std::optional<double> number = ParseNumber<double>(words[n]);
    if (!number.has_value()) return BadField(field, text, "holds what is not a number");
    point[n] = *number;
  }
  return point;
}

// The vectors of a field, which may hold blanks inside; "none" gives nothing.
absl::StatusOr<std::vector<std::optional<WorldPoint>>> VectorsOf(std::string_view field,
                                                                 std::string_view text) {
  std::vector<std::optional<WorldPoint>> vectors;
  for (text = Trimmed(text); !text.empty(); text = Trimmed(text)) {
    const bool none = text.starts_with("none");
    const size_t end = none ? 4 : text.find(')') + 1;
    if (end == 0) return BadField(field, text, "has no end");
    if (none) {
      vectors.emplace_back();
    } else {
      BCCSKEL_ASSIGN_OR_RETURN(vectors.emplace_back(), VectorOf(field, text.substr(0, end)));
    }
    text.remove_prefix(end);
  }
  return vectors;
}

// What the header says of each axis. Axes of values, as of components, have neither step nor
// spacing.
struct AxisFields {
  std::vector<std::optional<WorldPoint>> steps;  // empty without "space directions"
  std::vector<double> spacings;                  // NaN where nobody knows; empty if not stated
  std::vector<std::string> units;                // empty if not stated

  bool IsOfValues(size_t axis) const {
    if (axis < steps.size()) return !steps[axis].has_value();
    return axis < spacings.size() && std::isnan(spacings[axis]);
  }
};

// The texts between quotes, also empty ones; without quotes the words.
std::vector<std::string> NrrdUnitsOf(std::string_view text) {
  std::vector<std::string> units;
  const bool quoted = text.find('"') != text.npos;
  if (!quoted) {
    for (const std::string_view word : Words(text)) units.emplace_back(word);
  }
  while (quoted && text.find('"') != text.npos) {
    text.remove_prefix(text.find('"') + 1);
    const size_t end = std::min(text.find('"'), text.size());
    units.emplace_back(Trimmed(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return units;
}

absl::StatusOr<AxisFields> AxisFieldsOf(const HeaderFields& fields) {
  AxisFields axes;
  if (const auto text = fields.Find({"space directions"}); text.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(axes.steps, VectorsOf("space directions", *text));
  } else if (const auto spacings = fields.Find({"spacings"}); spacings.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(axes.spacings, ParseNumbers<double>("spacings", *spacings));
  }
  axes.units = NrrdUnitsOf(fields.Find({"units"}).value_or(""));
  return axes;
}

// An axis of one value in front of more than three, such as that of a single component, is dropped.
void DropAxisOfOneValue(std::vector<int64_t>& sizes, AxisFields& axes) {
  if (sizes.size() <= 3 || sizes.front() != 1 || !axes.IsOfValues(0)) return;
  sizes.erase(sizes.begin());
  if (!axes.steps.empty()) axes.steps.erase(axes.steps.begin());
  if (!axes.spacings.empty()) axes.spacings.erase(axes.spacings.begin());
  if (!axes.units.empty()) axes.units.erase(axes.units.begin());
}

// Of the coordinates of space or, where the file states those of its axes alone, of these. Then
// directions must have one unit, since they lead along several axes.
absl::StatusOr<CommonUnit> NrrdUnitOf(const HeaderFields& fields, const AxisFields& axes,
                                      const std::vector<int64_t>& sizes) {
  std::array<std::optional<std::string>, 3> units;
  const auto space = fields.Find({"space units"});
  const std::vector<std::string> stated = space.has_value() ? NrrdUnitsOf(*space) : axes.units;
  for (size_t n = 0; n < std::min<size_t>(3, stated.size()); ++n) {
    const bool alone = !space.has_value() && n < sizes.size() && sizes[n] == 1;
    if (!alone || !stated[n].empty()) units[n] = stated[n];
  }
  BCCSKEL_ASSIGN_OR_RETURN(CommonUnit common, CommonUnitOf(units));
  const bool converted = common.factors != CommonUnit().factors;
  if (!converted || space.has_value() || axes.steps.empty()) return common;
  return absl::UnimplementedError(
      "units differ between axes and do not say in which unit the space directions are: state "
      "'space units'");
}

// Where a file states the steps of two axes only.
WorldPoint UnitNormalOf(const WorldPoint& a, const WorldPoint& b) {
  const WorldPoint normal = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                             a[0] * b[1] - a[1] * b[0]};
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  if (length == 0) return {0, 0, 1};
  return {normal[0] / length, normal[1] / length, normal[2] / length};
}

absl::StatusOr<Placement> NrrdPlacementOf(const HeaderFields& fields, const AxisFields& axes,
                                          const CommonUnit& unit) {
  WorldPoint origin = {0, 0, 0};
  if (const auto text = fields.Find({"space origin"}); text.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(origin, VectorOf("space origin", *text));
  }
  std::array<double, 3> spacing = {1, 1, 1};
  for (size_t axis = 0; axis < std::min<size_t>(3, axes.spacings.size()); ++axis) {
    if (!std::isnan(axes.spacings[axis])) spacing[axis] = axes.spacings[axis];
  }
  for (size_t n = 0; n < 3; ++n) {
    spacing[n] *= unit.factors[n];
    origin[n] *= unit.factors[n];
  }
  if (axes.steps.empty()) return PlacementOfSpacing(spacing, origin);
  std::array<WorldPoint, 3> steps = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (size_t axis = 0; axis < std::min<size_t>(3, axes.steps.size()); ++axis) {
    if (!axes.steps[axis].has_value()) {
      return BadField("space directions", fields.Find({"space directions"}).value_or(""),
                      "has no direction for one of the first three axes");
    }
    steps[axis] = *axes.steps[axis];
  }
  if (axes.steps.size() == 2) steps[2] = UnitNormalOf(steps[0], steps[1]);
  for (WorldPoint& step : steps) {
    for (size_t n = 0; n < 3; ++n) step[n] *= unit.factors[n];
  }
  return PlacementOfSteps(steps, origin);
}

std::string NrrdWorldOf(const HeaderFields& fields) {
  const std::string name = LowerCase(fields.Find({"space"}).value_or(""));
  for (const SpaceName& space : kSpaces) {
    if (name == space.name) return std::string(space.axes);
  }
  return "";
}

HeaderLine ClassifyNrrdLine(std::string_view line) {
  if (line.empty()) return HeaderLine::kEnd;
  const bool key_value = line.find(":=") != line.npos;
  const bool ignored = line.starts_with('#') || line.starts_with("NRRD000") || key_value;
  return ignored ? HeaderLine::kIgnored : HeaderLine::kField;
}

absl::Status PlaceNrrdVoxels(const ImageFront& front, const HeaderFields& fields,
                             StoredImage& image) {
  BCCSKEL_ASSIGN_OR_RETURN(const Compression compression, NrrdCompressionOf(fields));
  if (fields.Find({"line skip", "lineskip"}).value_or("0") != "0") {
    return absl::UnimplementedError("the field 'line skip' is not supported");
  }
  const std::string_view skip = fields.Find({"byte skip", "byteskip"}).value_or("0");
  if (const auto name = fields.Find({"data file", "datafile"}); name.has_value()) {
    return PlaceDetached(front, *name, "byte skip", skip, compression, image);
  }
  BCCSKEL_ASSIGN_OR_RETURN(const size_t header_bytes, fields.Bytes());
  if (skip != "0") {
    return absl::UnimplementedError("the field 'byte skip' is read for data files only");
  }
  return PlaceBehindHeader(front, header_bytes, compression, image);
}

}  // namespace

bool IsNrrd(std::string_view front) { return front.starts_with("NRRD000"); }

absl::StatusOr<StoredImage> ParseNrrd(const ImageFront& front, const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const HeaderFields fields,
                           HeaderFields::Read(front.bytes, {": ", ClassifyNrrdLine}));
  StoredImage image;
  image.info.format = "NRRD";
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<int64_t> sizes, NrrdSizesOf(fields));
  BCCSKEL_ASSIGN_OR_RETURN(AxisFields axes, AxisFieldsOf(fields));
  DropAxisOfOneValue(sizes, axes);
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, SizeOfAxes(sizes, limits));
  BCCSKEL_ASSIGN_OR_RETURN(image.stored_type, NrrdTypeOf(fields));
  BCCSKEL_ASSIGN_OR_RETURN(image.byte_order, NrrdByteOrderOf(fields, image.stored_type));
  BCCSKEL_ASSIGN_OR_RETURN(const CommonUnit unit, NrrdUnitOf(fields, axes, sizes));
  BCCSKEL_ASSIGN_OR_RETURN(image.info.placement, NrrdPlacementOf(fields, axes, unit));
  image.info.unit = unit.unit;
  image.info.world = NrrdWorldOf(fields);
  BCCSKEL_RETURN_IF_ERROR(PlaceNrrdVoxels(front, fields, image));
  return image;
}

}  // namespace bccskel
