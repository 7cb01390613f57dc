#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_CURVE_COLORS_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_CURVE_COLORS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// The range of radii of a graph's points, nodes and sheets; {0, 0} for an empty graph.
struct RadiusRange {
  double low;
  double high;
};
RadiusRange RadiusRangeOf(const SkeletonGraph& graph);

// The color of a radius: thin is dark violet, thick is orange.
inline constexpr int kRadiusColors = 24;
int RadiusColorIndex(double radius, const RadiusRange& range);  // 0..kRadiusColors - 1
std::array<double, 3> RadiusRgb(int index);                     // 0..255 each
std::string RadiusColor(int index);                             // "#rrggbb"

// The color of a label by its place in a list: neighbors have distant hues. As on the page.
std::array<double, 3> LabelRgb(uint32_t place, double lightness = 0.42);  // 0..255 each
std::string HexColor(const std::array<double, 3>& rgb);                   // "#rrggbb"

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_CURVE_COLORS_H_
