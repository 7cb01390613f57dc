#include "client/export/picture/curve_colors.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace bccskel::exporting {
namespace {

using Rgb = std::array<double, 3>;
// Dark enough on white everywhere, and distinguishable without red and green.
constexpr std::array<Rgb, 5> kRadiusScale = {
    {{46, 16, 101}, {124, 29, 130}, {196, 45, 96}, {235, 94, 40}, {245, 158, 11}}};

}  // namespace

RadiusRange RadiusRangeOf(const SkeletonGraph& graph) {
  if (graph.nodes.empty()) return {0, 0};
  const double first = graph.RadiusOf(graph.nodes.front().at);
  RadiusRange range = {first, first};
  const auto include = [&](const SkeletonPoint& p) {
    range.low = std::min(range.low, graph.RadiusOf(p));
    range.high = std::max(range.high, graph.RadiusOf(p));
  };
  for (const SkeletonNode& node : graph.nodes) include(node.at);
  for (const SkeletonPoint& p : graph.points) include(p);
  for (const SkeletonPoint& p : graph.sheets) include(p);
  return range;
}

int RadiusColorIndex(double radius, const RadiusRange& range) {
  if (range.high <= range.low) return kRadiusColors / 2;
  const double part = (radius - range.low) / (range.high - range.low);
  return std::clamp(static_cast<int>(part * kRadiusColors), 0, kRadiusColors - 1);
}

std::array<double, 3> RadiusRgb(int index) {
  const double place = static_cast<double>(index) / (kRadiusColors - 1) * (kRadiusScale.size() - 1);
  const size_t stop = std::min(static_cast<size_t>(place), kRadiusScale.size() - 2);
  const double part = place - static_cast<double>(stop);
  Rgb color;
  for (size_t n = 0; n < 3; ++n) {
    color[n] = kRadiusScale[stop][n] * (1 - part) + kRadiusScale[stop + 1][n] * part;
  }
  return color;
}

std::string RadiusColor(int index) { return HexColor(RadiusRgb(index)); }

Rgb LabelRgb(uint32_t place, double lightness) {
  // HSL; the golden ratio spreads the hues of any number of labels.
  constexpr double kGoldenRatio = 0.618034, kSaturation = 0.68;
  const double hue = std::fmod(place * kGoldenRatio, 1);
  const double reach = kSaturation * std::min(lightness, 1 - lightness);
  Rgb color;
  for (size_t n = 0; n < 3; ++n) {
    const double at = std::fmod(hue * 12 + std::array{0.0, 8.0, 4.0}[n], 12);
    color[n] = 255 * (lightness - reach * std::max(-1.0, std::min({at - 3, 9 - at, 1.0})));
  }
  return color;
}

std::string HexColor(const Rgb& rgb) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string color = "#";
  for (const double value : rgb) {
    const auto byte = static_cast<size_t>(std::lround(value));
    color.push_back(kHex[byte >> 4]);
    color.push_back(kHex[byte & 15]);
  }
  return color;
}

}  // namespace bccskel::exporting
