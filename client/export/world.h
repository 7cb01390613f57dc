#ifndef BCCSKEL_CLIENT_EXPORT_WORLD_H_
#define BCCSKEL_CLIENT_EXPORT_WORLD_H_

#include <string>
#include <string_view>

#include "core/lattice/length_unit.h"

namespace bccskel::exporting {

// Axes of glTF files: y points up.
inline constexpr char kYUp[] = "y-up";

// The meaning of coordinates as stated by the input. Empty: unknown.
struct World {
  std::string axes;  // where they point: "RAS", "LPS", kYUp
  std::string unit;  // of coordinates, radii and lengths: "mm", "um", ...
};

// The note of formats with a unit of their own; empty where the input's can be converted.
inline std::string NoteOnUnit(const World& world, const std::string& taken_for) {
  if (NanometersOf(world.unit).has_value()) return "";
  return (world.unit.empty() ? "the input does not state its unit of length"
                             : "the unit '" + world.unit + "' is not a known unit of length") +
         "; coordinates are taken for " + taken_for;
}

inline std::string_view OrUnknown(std::string_view text) { return text.empty() ? "unknown" : text; }

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_WORLD_H_
