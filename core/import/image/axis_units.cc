#include "core/import/image/axis_units.h"

#include <algorithm>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "core/lattice/length_unit.h"

namespace bccskel {
namespace {

absl::Status NotConvertible(const std::array<std::optional<std::string>, 3>& units) {
  std::string list;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!units[axis].has_value()) continue;
    const std::string unit = UnitNamed(*units[axis]);
    absl::StrAppendFormat(&list, "%s%s along %c", list.empty() ? "" : ", ",
                          unit.empty() ? "no unit" : absl::StrFormat("'%s'", unit), "xyz"[axis]);
  }
  return absl::UnimplementedError(
      absl::StrFormat("lengths are in different units (%s) that cannot be converted to one: save "
                      "the image with one unit for all axes",
                      list));
}

}  // namespace

absl::StatusOr<CommonUnit> CommonUnitOf(const std::array<std::optional<std::string>, 3>& units) {
  std::vector<size_t> axes;  // those that matter
  CommonUnit common;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (units[axis].has_value()) axes.push_back(axis);
  }
  if (axes.empty()) return common;
  const auto unit = [&units](size_t axis) { return UnitNamed(*units[axis]); };
  common.unit = unit(axes.front());
  if (std::ranges::all_of(axes, [&](size_t axis) { return unit(axis) == common.unit; })) {
    return common;
  }
  double least = 0;
  for (const size_t axis : axes) {
    const std::optional<double> nanometers = NanometersOf(unit(axis));
    if (!nanometers.has_value()) return NotConvertible(units);
    common.factors[axis] = *nanometers;
    if (least == 0 || *nanometers < least) least = *nanometers;
  }
  for (const size_t axis : axes) {
    if (common.factors[axis] == least) common.unit = unit(axis);
    common.factors[axis] /= least;
  }
  return common;
}

}  // namespace bccskel
