#ifndef BCCSKEL_CORE_LATTICE_LENGTH_UNIT_H_
#define BCCSKEL_CORE_LATTICE_LENGTH_UNIT_H_

#include <optional>
#include <string>
#include <string_view>

namespace bccskel {

// The short name of a unit of length that a file may write in many ways: "um" for "\u00B5m" as
// ImageJ escapes it, for "micron", ... Other names stay if they are plain words, since results of
// every format repeat them; the rest is unknown.
std::string UnitNamed(std::string_view name);

// The number of nanometers in a unit of any of these names; nothing for another.
std::optional<double> NanometersOf(std::string_view unit);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LATTICE_LENGTH_UNIT_H_
