#include "client/cli/mesh_summary.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "client/export/picture/caption.h"
#include "client/export/text.h"

namespace bccskel::cli {
namespace {

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
    text.Add("not watertight (", GroupedDigits(report.boundary_edges), " boundary edges, ",
             GroupedDigits(report.non_manifold_edges), " non-manifold edges)");
  }
}

void AddTriple(Text& text, const std::array<double, 3>& values) {
  text.Add('[', values[0], ',', values[1], ',', values[2], ']');
}

// JSON has no infinities.
void AddNumberOrNull(Text& text, double value) {
  if (std::isfinite(value)) {
    text.Add(value);
  } else {
    text.Add("null");
  }
}

void AddGenus(Text& text, const std::optional<int64_t>& genus) {
  if (genus.has_value()) {
    text.Add(*genus);
  } else {
    text.Add("null");
  }
}

void AddSolid(Text& text, const std::optional<SolidTopology>& solid) {
  if (!solid.has_value()) {
    text.Add("null");
    return;
  }
  text.Add("{\"components\":", solid->components, ",\"loops\":", solid->loops,
           ",\"cavities\":", solid->cavities, '}');
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

std::string MeshText(const MeshReport& report) {
  Text text;
  text.Add("vertices:    ", GroupedDigits(report.vertices), '\n');
  text.Add("triangles:   ", GroupedDigits(report.triangles), " (",
           GroupedDigits(report.dropped_triangles), " degenerate ones dropped)\n");
  text.Add("surface:     ");
  AddClosure(text, report);
  text.Add(report.consistently_oriented() ? ", consistently oriented" : ", orientation mixed",
           '\n');
  text.Add("components:  ", report.components.size(), '\n');
  if (report.genus.has_value()) text.Add("genus:       ", *report.genus, '\n');
  if (const auto solid = report.SolidByWinding(); solid.has_value()) {
    text.Add("solid:       ",
             exporting::BettiPhrase({solid->components, solid->loops, solid->cavities}), '\n');
  }
  text.Add("box:         ");
  AddTriple(text, report.lower);
  text.Add(" to ");
  AddTriple(text, report.upper);
  text.Add("\nvolume:      ", report.volume, '\n');
  return std::move(text).Take();
}

std::string MeshJson(const MeshReport& report) {
  Text text;
  text.Add("{\"vertices\":", report.vertices, ",\"triangles\":", report.triangles,
           ",\"dropped_triangles\":", report.dropped_triangles,
           ",\"boundary_edges\":", report.boundary_edges,
           ",\"non_manifold_edges\":", report.non_manifold_edges,
           ",\"misoriented_edges\":", report.misoriented_edges, ",\"closure\":\"",
           ClosureName(report.closure), "\",\"watertight\":", JsonBool(report.watertight()),
           ",\"consistently_oriented\":", JsonBool(report.consistently_oriented()),
           ",\"components\":", report.components.size(), ",\"genus\":");
  AddGenus(text, report.genus);
  text.Add(",\"solid\":");
  AddSolid(text, report.SolidByWinding());
  text.Add(",\"volume\":");
  AddNumberOrNull(text, report.volume);
  text.Add(",\"box\":[");
  AddTriple(text, report.lower);
  text.Add(',');
  AddTriple(text, report.upper);
  text.Add("]}");
  return std::move(text).Take();
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

}  // namespace bccskel::cli
