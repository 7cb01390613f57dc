#ifndef BCCSKEL_CLIENT_EXPORT_WORLD_H_
#define BCCSKEL_CLIENT_EXPORT_WORLD_H_

#include <string>
#include <string_view>

namespace bccskel::exporting {

// Axes of glTF files: y points up.
inline constexpr char kYUp[] = "y-up";

// The meaning of coordinates as stated by the input. Empty: unknown.
struct World {
  std::string axes;  // where they point: "RAS", "LPS", kYUp
  std::string unit;  // of coordinates, radii and lengths: "mm", "um", ...
};

inline std::string_view OrUnknown(std::string_view text) { return text.empty() ? "unknown" : text; }

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_WORLD_H_
