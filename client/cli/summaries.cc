#include "client/cli/summaries.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/cli/load_object.h"
#include "client/export/method_facts.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"

namespace bccskel::cli {
namespace {

using exporting::Counted;
using exporting::GroupedDigits;
using exporting::Text;

std::string_view ClosureName(SurfaceClosure closure) {
  switch (closure) {
    case SurfaceClosure::kOpen:
      return "open";
    case SurfaceClosure::kClosed:
      return "closed";
    case SurfaceClosure::kOriented:
      return "oriented";
  }
  return "";  // not reached: the enumerators are exhausted above
}

void AddClosure(Text& text, const MeshReport& report) {
  if (report.watertight()) {
    text.Add("watertight");
  } else {
    text.Add("not watertight (", Counted(report.boundary_edges, "boundary edge", "boundary edges"),
             ", ", Counted(report.non_manifold_edges, "non-manifold edge", "non-manifold edges"),
             ')');
  }
}

void AddTriple(Text& text, const std::array<double, 3>& values) {
  text.Add('[', values[0], ',', values[1], ',', values[2], ']');
}

// JSON has no infinities.
std::optional<double> Finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<BettiNumbers> BettiOf(const MeshReport& report) {
  const std::optional<SolidTopology> solid = report.SolidByWinding();
  if (!solid.has_value()) return std::nullopt;
  return BettiNumbers{solid->components, solid->loops, solid->cavities};
}

// The axes of the grid in the world, to four digits; "" where they are the world's.
std::string DirectionLine(const Placement& placement) {
  if (placement.direction == Placement().direction) return "";
  const auto& d = placement.direction;
  return absl::StrFormat("direction:   %.4g %.4g %.4g, %.4g %.4g %.4g, %.4g %.4g %.4g\n", d[0],
                         d[3], d[6], d[1], d[4], d[7], d[2], d[5], d[8]);
}

void AddGrid(Text& text, const ImageInfo& info) {
  text.Add(info.size.nx, " x ", info.size.ny, " x ", info.size.nz, ' ', VoxelTypeName(info.type));
}

std::string_view JsonBool(bool value) { return value ? "true" : "false"; }

}  // namespace

std::string MeshPhrase(const MeshReport& report) {
  Text text;
  text.Add(GroupedDigits(report.vertices), " vertices, ", GroupedDigits(report.triangles),
           " triangles, ");
  AddClosure(text, report);
  if (report.genus.has_value()) text.Add(", genus ", *report.genus);
  return std::move(text).Take();
}

std::string MeshText(const MeshReport& report, std::optional<uint64_t> crossings) {
  Text text;
  text.Add("vertices:    ", GroupedDigits(report.vertices), '\n');
  text.Add("triangles:   ", GroupedDigits(report.triangles), " (",
           GroupedDigits(report.dropped_triangles), " degenerate ones dropped",
           report.two_sided_triangles == 0
               ? ""
               : "; " + GroupedDigits(report.two_sided_triangles) + " present from both sides",
           ")\n");
  text.Add("surface:     ");
  AddClosure(text, report);
  text.Add(report.consistently_oriented() ? ", consistently oriented" : ", orientation mixed",
           '\n');
  if (crossings.value_or(0) > 0) {
    text.Add("crossings:   ", Counted(*crossings, "pair of triangles", "pairs of triangles"), '\n');
  }
  text.Add("components:  ", report.components.size(), '\n');
  if (report.genus.has_value()) text.Add("genus:       ", *report.genus, '\n');
  if (const auto solid = BettiOf(report); solid.has_value()) {
    text.Add("solid:       ", exporting::BettiPhrase(*solid), '\n');
  }
  text.Add("box:         ");
  AddTriple(text, report.lower);
  text.Add(" to ");
  AddTriple(text, report.upper);
  text.Add("\nvolume:      ", report.volume, '\n');
  return std::move(text).Take();
}

std::string MeshJson(const MeshReport& report, std::optional<uint64_t> crossings) {
  const std::optional<BettiNumbers> solid = BettiOf(report);
  Text text;
  text.Add("{\"vertices\":", report.vertices, ",\"triangles\":", report.triangles,
           ",\"dropped_triangles\":", report.dropped_triangles,
           ",\"boundary_edges\":", report.boundary_edges,
           ",\"non_manifold_edges\":", report.non_manifold_edges,
           ",\"misoriented_edges\":", report.misoriented_edges, ",\"closure\":\"",
           ClosureName(report.closure), "\",\"watertight\":", JsonBool(report.watertight()),
           ",\"consistently_oriented\":", JsonBool(report.consistently_oriented()));
  if (crossings.has_value()) text.Add(",\"crossings\":", *crossings);
  text.Add(",\"components\":", report.components.size(), ",\"genus\":", report.genus,
           ",\"solid\":", solid.has_value() ? exporting::BettiJson(*solid) : "null",
           ",\"volume\":", Finite(report.volume), ",\"box\":[");
  AddTriple(text, report.lower);
  text.Add(',');
  AddTriple(text, report.upper);
  text.Add("]}");
  return std::move(text).Take();
}

std::string JsonStrings(const std::vector<std::string>& texts) {
  Text json;
  json.Add('[');
  for (size_t n = 0; n < texts.size(); ++n) json.Add(n > 0 ? "," : "", JsonString(texts[n]));
  return std::move(json.Add(']')).Take();
}

std::string FilesText(const std::vector<WrittenFile>& files) {
  Text text;
  for (const WrittenFile& file : files) {
    text.Add("written:   ", file.path, file.note.empty() ? "" : ", ", file.note, '\n');
  }
  return std::move(text).Take();
}

std::string FilesJson(const std::vector<WrittenFile>& files) {
  Text text;
  text.Add('[');
  for (size_t n = 0; n < files.size(); ++n) {
    text.Add(n > 0 ? "," : "", "{\"path\":", JsonString(files[n].path),
             ",\"note\":", JsonString(files[n].note), '}');
  }
  return std::move(text.Add(']')).Take();
}

std::string FilesJson(const ResultArguments& arguments) {
  return "{\"result\":" + JsonString(arguments.result) +
         ",\"object\":" + JsonString(arguments.object) +
         ",\"output\":" + JsonString(arguments.output);
}

MeshStage MeshStageOf(VoxelizeResult& result) {
  return {std::move(result.mesh), result.fill, result.added_points, std::move(result.warnings)};
}

std::string ThinPartsPhrase(const MeshStage& stage) {
  if (stage.added_points == 0) return "";
  return exporting::Counted(stage.added_points, "point", "points") +
         " added, so that parts thinner than two lattice units stay whole";
}

std::string MeshStageJson(const MeshStage& stage) {
  return "\"mesh\":" + MeshJson(stage.mesh) + ",\"fill\":\"" + FillRuleName(stage.fill) +
         "\",\"added_points\":" + std::to_string(stage.added_points) +
         ",\"warnings\":" + JsonStrings(stage.warnings);
}

std::string FillRuleName(FillRule rule) {
  switch (rule) {
    case FillRule::kAuto:
      return "auto";
    case FillRule::kParity:
      return "parity";
    case FillRule::kWinding:
      return "winding";
  }
  return "";  // not reached: the enumerators are exhausted above
}

std::string VolumeText(const Volume& volume, const std::optional<BettiNumbers>& betti) {
  const LatticeExtent& extent = volume.extent();
  const Placement& placement = volume.placement();
  Text text;
  text.Add("extent:      ", extent.nx, " x ", extent.ny, " x ", extent.nz, " cells\n");
  text.Add("spacing:     ", placement.spacing[0], " x ", placement.spacing[1], " x ",
           placement.spacing[2], '\n');
  text.Add("origin:      ", placement.origin[0], ' ', placement.origin[1], ' ', placement.origin[2],
           '\n', DirectionLine(placement));
  text.Add("points:      ", GroupedDigits(volume.PointCount()), " in ",
           GroupedDigits(volume.brick_count()), " bricks\n");
  if (betti.has_value()) text.Add("topology:    ", exporting::BettiPhrase(*betti), '\n');
  return std::move(text).Take();
}

std::string VolumeJson(const Volume& volume, const std::optional<BettiNumbers>& betti) {
  const LatticeExtent& extent = volume.extent();
  Text text;
  text.Add("{\"extent\":[", extent.nx, ',', extent.ny, ',', extent.nz, "],",
           exporting::PlacementJson(volume.placement()));
  text.Add(",\"points\":", volume.PointCount(), ",\"bricks\":", volume.brick_count());
  if (betti.has_value()) text.Add(",\"topology\":", exporting::BettiJson(*betti));
  text.Add('}');
  return std::move(text).Take();
}

std::string ImagePhrase(const ImageStage& image) {
  Text text;
  text.Add(image.info.format, ", ");
  AddGrid(text, image.info);
  text.Add(", ", Counted(image.voxels, "voxel", "voxels"));
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
           info.world.empty() ? "" : " ", info.world, '\n', DirectionLine(placement));
  text.Add("foreground:  ", Counted(image.voxels, "voxel", "voxels"), '\n');
  text.Add("topology:    ", exporting::BettiPhrase(image.mask), '\n');
  return std::move(text).Take();
}

std::string ImageJson(const ImageStage& image, const std::string& members) {
  const ImageInfo& info = image.info;
  Text text;
  text.Add("{\"format\":", JsonString(info.format), ",\"size\":[", info.size.nx, ',', info.size.ny,
           ',', info.size.nz, "],\"type\":", JsonString(VoxelTypeName(info.type)), ',',
           exporting::PlacementJson(info.placement), ",\"unit\":", JsonString(info.unit),
           ",\"world\":", JsonString(info.world), ",\"voxels\":", image.voxels,
           ",\"topology\":", exporting::BettiJson(image.mask),
           ",\"warnings\":", JsonStrings(image.warnings));
  text.Add(members);
  return std::move(text.Add('}')).Take();
}

}  // namespace bccskel::cli
