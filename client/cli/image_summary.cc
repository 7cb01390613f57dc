#include "client/cli/image_summary.h"

#include <utility>

#include "client/cli/json_text.h"
#include "client/cli/volume_summary.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"

namespace bccskel::cli {
namespace {

using exporting::GroupedDigits;
using exporting::Text;

void AddGrid(Text& text, const ImageInfo& info) {
  text.Add(info.size.nx, " x ", info.size.ny, " x ", info.size.nz, ' ', VoxelTypeName(info.type));
}

}  // namespace

std::string ImagePhrase(const ImageStage& image) {
  Text text;
  text.Add(image.info.format, ", ");
  AddGrid(text, image.info);
  text.Add(", ", GroupedDigits(image.voxels), " voxels");
  return std::move(text).Take();
}

std::string ImageText(const ImageStage& image) {
  const ImageInfo& info = image.info;
  const Placement& placement = info.placement;
  Text text;
  text.Add("format:      ", info.format, "\nsize:        ");
  AddGrid(text, info);
  text.Add("\nspacing:     ", placement.spacing[0], " x ", placement.spacing[1], " x ",
           placement.spacing[2], info.unit.empty() ? "" : " ", info.unit, '\n');
  text.Add("origin:      ", placement.origin[0], ' ', placement.origin[1], ' ', placement.origin[2],
           info.world.empty() ? "" : " ", info.world, '\n');
  text.Add("foreground:  ", GroupedDigits(image.voxels), " voxels\n");
  text.Add("topology:    ", exporting::BettiPhrase(image.mask), '\n');
  return std::move(text).Take();
}

std::string ImageJson(const ImageStage& image, const std::optional<ImageValues>& values) {
  const ImageInfo& info = image.info;
  Text text;
  text.Add("{\"format\":", JsonString(info.format), ",\"size\":[", info.size.nx, ',', info.size.ny,
           ',', info.size.nz, "],\"type\":", JsonString(VoxelTypeName(info.type)), ',',
           PlacementJson(info.placement), ",\"unit\":", JsonString(info.unit),
           ",\"world\":", JsonString(info.world), ",\"voxels\":", image.voxels,
           ",\"topology\":", BettiJson(image.mask));
  if (values.has_value()) text.Add(",\"values\":{", ValuesJson(*values), '}');
  return std::move(text.Add('}')).Take();
}

}  // namespace bccskel::cli
