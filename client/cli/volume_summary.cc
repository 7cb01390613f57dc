#include "client/cli/volume_summary.h"

#include <utility>

#include "client/export/picture/caption.h"
#include "client/export/text.h"

namespace bccskel::cli {
namespace {

using exporting::GroupedDigits;
using exporting::Text;

template <typename Values>
void AddList(Text& text, const Values& values) {
  char separator = '[';
  for (const double value : values) {
    text.Add(separator, value);
    separator = ',';
  }
  text.Add(']');
}

}  // namespace

std::string BettiJson(const BettiNumbers& betti) {
  Text text;
  text.Add("{\"components\":", betti.components, ",\"loops\":", betti.loops,
           ",\"cavities\":", betti.cavities, '}');
  return std::move(text).Take();
}

std::string PlacementJson(const Placement& placement) {
  Text text;
  text.Add("\"spacing\":");
  AddList(text, placement.spacing);
  text.Add(",\"origin\":");
  AddList(text, placement.origin);
  text.Add(",\"direction\":");
  AddList(text, placement.direction);
  return std::move(text).Take();
}

std::string VolumeText(const Volume& volume, const std::optional<BettiNumbers>& betti) {
  const LatticeExtent& extent = volume.extent();
  const Placement& placement = volume.placement();
  Text text;
  text.Add("extent:      ", extent.nx, " x ", extent.ny, " x ", extent.nz, " cells\n");
  text.Add("spacing:     ", placement.spacing[0], " x ", placement.spacing[1], " x ",
           placement.spacing[2], '\n');
  text.Add("origin:      ", placement.origin[0], ' ', placement.origin[1], ' ', placement.origin[2],
           '\n');
  text.Add("points:      ", GroupedDigits(volume.PointCount()), " in ",
           GroupedDigits(volume.brick_count()), " bricks\n");
  if (betti.has_value()) text.Add("topology:    ", exporting::BettiPhrase(*betti), '\n');
  return std::move(text).Take();
}

std::string VolumeJson(const Volume& volume, const std::optional<BettiNumbers>& betti) {
  const LatticeExtent& extent = volume.extent();
  Text text;
  text.Add("{\"extent\":[", extent.nx, ',', extent.ny, ',', extent.nz, "],",
           PlacementJson(volume.placement()));
  text.Add(",\"points\":", volume.PointCount(), ",\"bricks\":", volume.brick_count());
  if (betti.has_value()) text.Add(",\"topology\":", BettiJson(*betti));
  text.Add('}');
  return std::move(text).Take();
}

}  // namespace bccskel::cli
