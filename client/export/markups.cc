#include "client/export/markups.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "client/export/branch_name.h"
#include "client/export/picture/escape.h"
#include "client/export/sampled_curve.h"
#include "core/lattice/length_unit.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

constexpr std::string_view kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
    "Schema/markups-schema-v1.0.3.json#";

// Slicer shows images in mm. One of the numbers is 1, so that nothing is rounded twice.
struct Millimeters {
  double times = 1;
  double per = 1;

  double Of(double length) const { return length * times / per; }
};

Millimeters MillimetersOf(const World& world) {
  constexpr double kNanometers = 1e6;
  const double unit = NanometersOf(world.unit).value_or(kNanometers);
  return {.times = std::max(1.0, unit / kNanometers), .per = std::max(1.0, kNanometers / unit)};
}

std::string UnitIn(const World& world) {
  return NanometersOf(world.unit).has_value() ? "mm" : world.unit;
}

void AddMeasurement(Text& text, std::string_view before, std::string_view name, double value,
                    const World& world) {
  const std::string unit = UnitIn(world);
  text.Add(before, "{\"name\":\"", name,
           "\",\"enabled\":false,\"value\":", MillimetersOf(world).Of(value));
  if (!unit.empty()) text.Add(",\"units\":", JsonString(unit));
  text.Add('}');
}

// Markups are RAS or LPS. LAS is RAS with the first axis reversed.
bool IsTurned(const World& world) { return world.axes == "LAS"; }

std::string_view SystemOf(const World& world) {
  return world.axes == "RAS" || IsTurned(world) ? "RAS" : "LPS";
}

void AddPoints(Text& text, const std::vector<CurvePoint>& curve, const World& world) {
  const double sign = IsTurned(world) ? -1 : 1;
  const Millimeters mm = MillimetersOf(world);
  for (size_t n = 0; n < curve.size(); ++n) {
    const WorldPoint& p = curve[n].at;
    text.Add(n == 0 ? "\n" : ",\n", "{\"id\":\"", n + 1,
             "\",\"label\":\"\",\"description\":\"radius ",
             static_cast<float>(mm.Of(curve[n].radius)), "\",\"position\":[", mm.Of(sign * p[0]),
             ',', mm.Of(p[1]), ',', mm.Of(p[2]),
             "],\"selected\":true,\"locked\":false,\"visibility\":true,"
             "\"positionStatus\":\"defined\"}");
  }
}

void AddCurve(Text& text, const SkeletonGraph& graph, size_t n, const GraphContext& context,
              const World& world) {
  const SkeletonEdge& edge = graph.edges[n];
  const bool closed = graph.nodes[edge.source].kind == NodeKind::kLoop;
  std::vector<CurvePoint> curve = SampledCurve(graph, edge);
  if (closed && !curve.empty()) curve.pop_back();  // equals the first
  const EdgeFigures figures = FiguresOf(graph, edge);
  text.Add("{\"type\":\"", closed ? "ClosedCurve" : "Curve", "\",\"coordinateSystem\":\"",
           SystemOf(world), '"');
  if (UnitIn(world) == "mm") text.Add(",\"coordinateUnits\":\"mm\"");
  text.Add(",\"name\":\"", BranchName(context.labels, n),
           "\",\"locked\":true,\"fixedNumberOfControlPoints\":false,\"labelFormat\":\"\","
           "\"lastUsedControlPointNumber\":",
           curve.size(), ",\"controlPoints\":[");
  AddPoints(text, curve, world);
  text.Add("],\"measurements\":[");
  AddMeasurement(text, "", "length", figures.length, world);
  AddMeasurement(text, ",", "mean radius", figures.mean_radius, world);
  AddMeasurement(text, ",", "min radius", figures.min_radius, world);
  AddMeasurement(text, ",", "max radius", figures.max_radius, world);
  text.Add(
      "],\"display\":{\"visibility\":true,\"pointLabelsVisibility\":false,"
      "\"propertiesLabelVisibility\":false,\"glyphScale\":0.5,\"lineThickness\":0.5}}");
}

// Empty for RAS and LPS in mm.
std::string NoteOn(const World& world) {
  std::string note;
  if (IsTurned(world)) {
    note = "the input's world is LAS; written as RAS, with the sign of x reversed";
  } else if (world.axes != "RAS" && world.axes != "LPS") {
    note = "the input does not state whether its world is RAS or LPS; written as LPS";
  }
  std::string on_unit = NoteOnUnit(world, "millimeters");
  if (on_unit.empty() && UnitNamed(world.unit) != "mm") {
    on_unit = "the input's unit is " + world.unit + "; coordinates are written in mm";
  }
  const bool both = !note.empty() && !on_unit.empty();
  return note + (both ? "; " : "") + on_unit;
}

}  // namespace

Document WriteMarkups(const SkeletonGraph& graph, const GraphContext& context, const World& world) {
  Text text;
  text.Add("{\"@schema\":\"", kSchema, "\",\n\"markups\":[");
  for (size_t n = 0; n < graph.edges.size(); ++n) {
    text.Add(n == 0 ? "\n" : ",\n");
    AddCurve(text, graph, n, context, world);
  }
  text.Add("\n]}\n");
  return {std::move(text).Take(), NoteOn(world)};
}

}  // namespace bccskel::exporting
