#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "client/export/graph_formats.h"
#include "client/export/picture/escape.h"
#include "client/export/sampled_curve.h"
#include "client/export/shared_text.h"
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

// Markups are RAS or LPS. LAS is RAS with the first axis reversed.
bool IsTurned(const World& world) { return world.axes == "LAS"; }

// How to write the coordinates and lengths of a world.
struct Frame {
  std::string_view system;
  double sign_of_x;
  bool known_unit;
  Millimeters mm;
  std::string units;  // a JSON member of a measurement; may be empty
};

Frame FrameOf(const World& world) {
  const bool known = NanometersOf(world.unit).has_value();
  const std::string unit = known ? "mm" : world.unit;
  return {.system = world.axes == "RAS" || IsTurned(world) ? "RAS" : "LPS",
          .sign_of_x = IsTurned(world) ? -1.0 : 1.0,
          .known_unit = known,
          .mm = MillimetersOf(world),
          .units = unit.empty() ? "" : ",\"units\":" + JsonString(unit)};
}

void AddMeasurement(Text& text, std::string_view before, std::string_view name, double value,
                    const Frame& frame) {
  text.Add(before, "{\"name\":\"", name, "\",\"enabled\":false,\"value\":", frame.mm.Of(value),
           frame.units, '}');
}

// Members that would have Slicer's defaults are left out: an empty label, a selected, visible and
// unlocked point with a defined position.
void AddPoints(Text& text, const std::vector<CurvePoint>& curve, const Frame& frame) {
  const Millimeters& mm = frame.mm;
  for (size_t n = 0; n < curve.size(); ++n) {
    const WorldPoint& p = curve[n].at;
    text.Add(n == 0 ? "\n" : ",\n", "{\"id\":\"", n + 1, "\",\"description\":\"radius ",
             static_cast<float>(mm.Of(curve[n].radius)), "\",\"position\":[",
             mm.Of(frame.sign_of_x * p[0]), ',', mm.Of(p[1]), ',', mm.Of(p[2]), "]}");
  }
}

void AddCurve(Text& text, const SkeletonGraph& graph, size_t n, const GraphContext& context,
              const Frame& frame) {
  const SkeletonEdge& edge = graph.edges[n];
  const bool closed = graph.nodes[edge.source].kind == NodeKind::kLoop;
  const std::vector<WorldPoint> smooth = SmoothCurve(graph, edge);
  std::vector<CurvePoint> curve = SampledCurve(graph, edge, smooth);
  if (closed && !curve.empty()) curve.pop_back();  // equals the first
  const EdgeFigures figures = FiguresOf(graph, edge, smooth);
  text.Add("{\"type\":\"", closed ? "ClosedCurve" : "Curve", "\",\"coordinateSystem\":\"",
           frame.system, '"');
  if (frame.known_unit) text.Add(",\"coordinateUnits\":\"mm\"");
  text.Add(",\"name\":\"", BranchName(context.labels, n),
           "\",\"locked\":true,\"labelFormat\":\"\",\"lastUsedControlPointNumber\":", curve.size(),
           ",\"controlPoints\":[");
  AddPoints(text, curve, frame);
  text.Add("],\"measurements\":[");
  AddMeasurement(text, "", "length", figures.length, frame);
  AddMeasurement(text, ",", "mean radius", figures.mean_radius, frame);
  AddMeasurement(text, ",", "min radius", figures.min_radius, frame);
  AddMeasurement(text, ",", "max radius", figures.max_radius, frame);
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
  const Frame frame = FrameOf(world);
  Text text(context.exec.stop);
  text.Add("{\"@schema\":\"", kSchema, "\",\n\"markups\":[");
  AddShared(text, graph.edges.size(), context.exec, [&] {
    return [&](Text& piece, size_t n) {
      piece.Add(n == 0 ? "\n" : ",\n");
      AddCurve(piece, graph, n, context, frame);
    };
  });
  text.Add("\n]}\n");
  return {std::move(text).Take(), NoteOn(world)};
}

}  // namespace bccskel::exporting
