#ifndef BCCSKEL_CORE_IMPORT_IMAGE_AXIS_UNITS_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_AXIS_UNITS_H_

#include <array>
#include <optional>
#include <string>

#include "absl/status/statusor.h"

namespace bccskel {

// The one unit that an image's world has, and what converts lengths along each axis to it.
struct CommonUnit {
  std::string unit;
  std::array<double, 3> factors = {1, 1, 1};
};

// Of the units that a file states along x, y and z: "" where it states none, nothing where the axis
// does not matter. It is the smallest of them, so that whole factors convert without rounding.
// Errors: UNIMPLEMENTED for different units that are not both known.
absl::StatusOr<CommonUnit> CommonUnitOf(const std::array<std::optional<std::string>, 3>& units);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_AXIS_UNITS_H_
