#include "client/export/picture/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "client/export/picture/beads.h"
#include "client/export/picture/caption.h"
#include "client/export/picture/curve_colors.h"
#include "client/export/picture/escape.h"
#include "client/export/picture/glass_image.h"
#include "client/export/picture/projection.h"
#include "client/export/text.h"
#include "client/view/display_surface.h"
#include "core/certificate/describe_changes.h"
#include "core/exec/status_macros.h"

namespace bccskel::exporting {
namespace {

// Of the glass images; the samples along each axis of a pixel.
constexpr double kPixelsPerUnit = 1.5;
constexpr int kSamplesPerPixel = 2;
constexpr double kMargin = 26;
// The glass images end inside the panels, whose corners are round.
constexpr double kRim = 8;
// Of curves, together: more are drawn into the glass images. They make files of about 20 MB.
constexpr size_t kMostPoints = 250'000;

// The position of a view in the picture.
struct Panel {
  double x;
  double y;
  PanelSize size;
};
constexpr std::array<Panel, 3> kPanels = {
    {{20, 84, {800, 716}}, {840, 84, {380, 348}}, {840, 452, {380, 348}}}};

// Two decimals are a hundredth of a pixel.
double Rounded(double v) { return std::round(v * 100) / 100; }

// The contents of all panels.
struct Scene {
  const SvgContent& content;
  const view::ResultDocument& result;
  std::vector<WorldPoint> shown;
  BeadStrings strings;
  bool dense;  // thin lines and small nodes
  bool drawn;  // curves and nodes are in the glass images
};

absl::StatusOr<Scene> SceneOf(const SvgContent& content) {
  BCCSKEL_ASSIGN_OR_RETURN(BeadStrings strings, BeadStrings::Of(content.result, content.context));
  const size_t points = content.result.nodes.size() + content.result.points.size();
  return Scene{.content = content,
               .result = content.result,
               .shown = view::ShownPoints(content.result, content.surface.vertices),
               .strings = std::move(strings),
               .dense = content.result.nodes.size() > 300,
               .drawn = points > kMostPoints};
}

double BoldnessIn(const PanelSize& panel) { return panel.width > 500 ? 1 : 0.7; }
double StrokeWidth(const Scene& scene, double boldness) {
  return (scene.dense ? 1.6 : 2.6) * boldness;
}

// The distance between neighbors on a sheet: those of the D8 lattice.
double SpacingOf(const view::ResultDocument& result) {
  if (!result.placement.has_value()) return 0;  // older versions
  return std::ranges::max(result.placement->spacing) * std::sqrt(3.0) / 2;
}

// Curves, nodes and points of sheets.
absl::StatusOr<Beads> BeadsOf(const Scene& scene, const Projection& projection, double thickness) {
  BCCSKEL_ASSIGN_OR_RETURN(Beads beads,
                           scene.strings.In(projection, thickness, scene.content.context));
  std::vector<Bead>& of_sheets = beads.emplace_back();
  const CurveColors& colors = scene.strings.colors();
  const view::ResultDocument::Sheets& sheets = scene.result.sheets;
  const double radius = std::max(SpacingOf(scene.result) * projection.scale() / 2, thickness / 2);
  for (size_t n = 0; n < sheets.points.size(); ++n) {
    const PanelPoint p = projection.Project(sheets.points[n]);
    of_sheets.push_back({static_cast<float>(p.x), static_cast<float>(p.y),
                         static_cast<float>(p.depth), static_cast<float>(radius),
                         colors.Linear(colors.NumberOfSheet(n))});
  }
  return beads;
}

// As a PNG file, on the panels' color.
absl::StatusOr<std::string> GlassImage(const Scene& scene, const View& view, const PanelSize& size,
                                       double boldness) {
  constexpr double kSamples = kPixelsPerUnit * kSamplesPerPixel;
  const Projection projection(view, scene.shown, {size.width * kSamples, size.height * kSamples},
                              (kMargin - kRim) * kSamples);
  Geometry geometry = GlassOf(scene.content.surface, projection);
  if (scene.drawn) {
    BCCSKEL_ASSIGN_OR_RETURN(
        geometry.beads, BeadsOf(scene, projection, StrokeWidth(scene, boldness) / 2 * kSamples));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const RgbImage image,
                           ImageOf(geometry, static_cast<int>(size.width * kPixelsPerUnit),
                                   static_cast<int>(size.height * kPixelsPerUnit), kSamplesPerPixel,
                                   scene.content.context));
  return PngOf(image);
}

// A piece of a curve in one color.
struct Stroke {
  std::vector<PanelPoint> points;
  int color;
  double depth;
};

// Cuts a curve where its color changes, and often enough that strokes can be sorted by depth.
void AppendStrokes(const Scene& scene, size_t number, const Projection& projection,
                   std::vector<Stroke>& strokes) {
  constexpr size_t kLongest = 12;
  const view::ResultDocument::Edge& edge = scene.result.edges[number];
  const std::span<const WorldPoint> curve = scene.strings.CurveOf(edge);
  const std::span<const double> radii = scene.result.RadiiOf(edge);
  for (size_t n = 1; n < curve.size(); ++n) {
    const int color = scene.strings.colors().NumberAt(edge, (radii[n - 1] + radii[n]) / 2);
    const PanelPoint p = projection.Project(curve[n - 1]);
    const bool starts =
        n == 1 || strokes.back().color != color || strokes.back().points.size() >= kLongest;
    if (starts) strokes.push_back({{p}, color, p.depth});
    strokes.back().points.push_back(projection.Project(curve[n]));
  }
}

std::vector<Stroke> StrokesFromBack(const Scene& scene, const Projection& projection) {
  std::vector<Stroke> strokes;
  for (size_t n = 0; n < scene.result.edges.size(); ++n) {
    AppendStrokes(scene, n, projection, strokes);
  }
  std::ranges::stable_sort(strokes, {}, &Stroke::depth);
  return strokes;
}

void AddPath(Text& svg, const Stroke& stroke, std::string_view style) {
  svg.Add("<path ", style, " d=\"M");
  for (const PanelPoint& p : stroke.points) svg.Add(' ', Rounded(p.x), ' ', Rounded(p.y));
  svg.Add("\"/>\n");
}

void AddStrokes(Text& svg, const std::vector<Stroke>& strokes, const CurveColors& colors,
                double width) {
  svg.Add("<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke-width=\"",
          Rounded(width), "\">\n");
  // A halo under every stroke shows which of two crossing branches is in front.
  Text halo;
  halo.Add("class=\"h\" stroke-width=\"", Rounded(width + 2.2), "\"");
  const std::string halo_style = std::move(halo).Take();
  for (const Stroke& stroke : strokes) {
    AddPath(svg, stroke, halo_style);
    AddPath(svg, stroke, "stroke=\"" + HexColor(colors.Rgb(stroke.color)) + "\"");
  }
  svg.Add("</g>\n");
}

struct ColoredDot {
  PanelPoint at;
  int color;
};

// The points of sheets, the nearest last. Consecutive dots of one color form one path of lines
// without length.
void AddSheets(Text& svg, const Scene& scene, const Projection& projection) {
  const view::ResultDocument::Sheets& sheets = scene.result.sheets;
  std::vector<ColoredDot> dots;
  for (size_t n = 0; n < sheets.points.size(); ++n) {
    dots.push_back({projection.Project(sheets.points[n]), scene.strings.colors().NumberOfSheet(n)});
  }
  std::ranges::stable_sort(dots, {}, [](const ColoredDot& dot) { return dot.at.depth; });
  svg.Add("<g fill=\"none\" stroke-linecap=\"round\" stroke-width=\"",
          Rounded(std::max(SpacingOf(scene.result) * projection.scale(), 1.0)), "\">\n");
  for (size_t n = 0; n < dots.size(); ++n) {
    const bool starts = n == 0 || dots[n].color != dots[n - 1].color;
    if (starts)
      svg.Add(n == 0 ? "" : "\"/>\n", "<path stroke=\"",
              HexColor(scene.strings.colors().Rgb(dots[n].color)), "\" d=\"");
    svg.Add("M", Rounded(dots[n].at.x), ' ', Rounded(dots[n].at.y), "h0");
  }
  svg.Add(dots.empty() ? "" : "\"/>\n", "</g>\n");
}

std::string_view NodeStyle(std::string_view kind) {
  if (kind == "end") return "fill=\"#fff\" stroke=\"#1f2937\"";
  if (kind == "junction") return "fill=\"#1f2937\" stroke=\"#fff\"";
  return "fill=\"#0d9488\" stroke=\"#fff\"";
}

void AddNodes(Text& svg, const view::ResultDocument& result, const Projection& projection,
              double radius) {
  for (const view::ResultDocument::Node& node : result.nodes) {
    if (node.kind == "loop") continue;  // represents its curve only
    const PanelPoint p = projection.Project(node.position);
    svg.Add("<circle cx=\"", Rounded(p.x), "\" cy=\"", Rounded(p.y), "\" r=\"", Rounded(radius),
            "\" stroke-width=\"", Rounded(radius / 3), "\" ", NodeStyle(node.kind), "/>\n");
  }
}

void AddAxes(Text& svg, const View& view, const PanelSize& size) {
  constexpr double kLength = 22;
  constexpr std::string_view kNames = "xyz";
  svg.Add("<g class=\"a\" transform=\"translate(46 ", size.height - 46, ")\">\n");
  for (size_t axis = 0; axis < 3; ++axis) {
    const double x = kLength * view.right[axis], y = -kLength * view.up[axis];
    if (x * x + y * y < 4) continue;  // points at the viewer
    svg.Add("<path d=\"M 0 0 L ", Rounded(x), ' ', Rounded(y), "\"/><text x=\"", Rounded(1.45 * x),
            "\" y=\"", Rounded(1.45 * y + 4), "\">", kNames.substr(axis, 1), "</text>\n");
  }
  svg.Add("</g>\n");
}

absl::Status AddPanel(Text& svg, const Scene& scene, const Panel& panel, const View& view) {
  const Projection projection(view, scene.shown, panel.size, kMargin);
  const PanelSize image = {panel.size.width - 2 * kRim, panel.size.height - 2 * kRim};
  const double boldness = BoldnessIn(panel.size);
  BCCSKEL_ASSIGN_OR_RETURN(const std::string png, GlassImage(scene, view, image, boldness));
  svg.Add("<svg x=\"", panel.x, "\" y=\"", panel.y, "\" width=\"", panel.size.width, "\" height=\"",
          panel.size.height, "\">\n<rect class=\"p\" width=\"100%\" ",
          "height=\"100%\" rx=\"10\"/>\n");
  svg.Add("<image x=\"", kRim, "\" y=\"", kRim, "\" width=\"", image.width, "\" height=\"",
          image.height, "\" href=\"data:image/png;base64,", absl::Base64Escape(png), "\"/>\n");
  if (!scene.drawn) {
    AddSheets(svg, scene, projection);
    AddStrokes(svg, StrokesFromBack(scene, projection), scene.strings.colors(),
               StrokeWidth(scene, boldness));
    AddNodes(svg, scene.result, projection, (scene.dense ? 1.8 : 3.6) * boldness);
  }
  AddAxes(svg, view, panel.size);
  svg.Add("</svg>\n");
  return absl::OkStatus();
}

// Four significant digits.
double Legible(double v) {
  if (v == 0) return 0;
  const double unit = std::pow(10.0, 3 - std::floor(std::log10(std::abs(v))));
  return std::round(v * unit) / unit;
}

void AddLegendText(Text& svg, double x, std::string_view anchor, std::string_view label) {
  svg.Add("<text class=\"s\" x=\"", x, "\" y=\"833\" text-anchor=\"", anchor, "\">", label,
          "</text>\n");
}

void AddRadiusLegend(Text& svg, const RadiusRange& radii, const std::string& unit) {
  constexpr double kBar = 150, kStep = 9;
  Text low, high;
  low.Add("radius ", Legible(radii.low));
  high.Add(Legible(radii.high), EscapeMarkup(unit));
  AddLegendText(svg, kBar - 8, "end", std::move(low).Take());
  for (int n = 0; n < kRadiusColors; ++n) {
    svg.Add("<rect x=\"", kBar + kStep * n, "\" y=\"822\" width=\"", kStep + 0.5,
            "\" height=\"12\" fill=\"", RadiusColor(n), "\"/>\n");
  }
  AddLegendText(svg, kBar + kStep * kRadiusColors + 8, "start", std::move(high).Take());
}

void AddNodeLegend(Text& svg, double x, std::string_view kind, std::string_view label) {
  svg.Add("<circle cx=\"", x, "\" cy=\"828\" r=\"4\" stroke-width=\"1.4\" ", NodeStyle(kind),
          "/>\n");
  AddLegendText(svg, x + 12, "start", label);
}

void AddLegend(Text& svg, const Scene& scene) {
  if (scene.result.labels.has_value()) {
    AddLegendText(svg, 20, "start", "each label in its own color");
  } else {
    AddRadiusLegend(svg, scene.strings.colors().range(), UnitBehind(scene.result));
  }
  AddNodeLegend(svg, 520, "end", "end");
  AddNodeLegend(svg, 588, "junction", "junction");
  AddNodeLegend(svg, 688, "isolated", "isolated point or closed surface");
}

void AddHead(Text& svg, const SvgContent& content) {
  const view::ResultDocument& result = content.result;
  const std::string size = content.skeleton_points.has_value()
                               ? Counted(*content.skeleton_points, "point", "points")
                               : Counted(result.edges.size(), "branch", "branches");
  svg.Add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" ",
          "viewBox=\"0 0 ", kSvgWidth, ' ', kSvgHeight, "\" width=\"", kSvgWidth, "\" height=\"",
          kSvgHeight, "\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n<style>",
          ".p{fill:#f8fafc;stroke:#e2e8f0}.h{stroke:#fff;stroke-linecap:butt}",
          ".s{font-size:13px;fill:#475569}.t{font-size:22px;font-weight:bold;fill:#0f172a}",
          ".a{stroke:#94a3b8;stroke-width:1.3}",
          ".a text{font-size:12px;fill:#64748b;stroke:none;text-anchor:middle}</style>\n",
          "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
  const std::string verdict = VerdictInWords(result.certificate);
  constexpr size_t kShort = 20;  // fits behind the other words
  svg.Add("<text class=\"t\" x=\"20\" y=\"34\">", EscapeMarkup(content.title), "</text>\n",
          "<text class=\"s\" x=\"20\" y=\"57\">", ObjectPhrase(result), "  →  ",
          SkeletonPhrase(result, size));
  if (verdict.size() <= kShort) {
    svg.Add(" (", verdict, ")</text>\n");
  } else {
    svg.Add("</text>\n<text class=\"s\" x=\"20\" y=\"76\">", EscapeMarkup(verdict), "</text>\n");
  }
}

}  // namespace

absl::StatusOr<std::string> SvgText(const SvgContent& content) {
  BCCSKEL_ASSIGN_OR_RETURN(const Scene scene, SceneOf(content));
  const std::array<View, 3> views =
      view::ViewsOf(view::FrontOf(content.result, content.surface.vertices));
  Text svg;
  AddHead(svg, content);
  for (size_t n = 0; n < kPanels.size(); ++n) {
    BCCSKEL_RETURN_IF_ERROR(AddPanel(svg, scene, kPanels[n], views[n]));
  }
  if (!content.result.nodes.empty()) AddLegend(svg, scene);
  svg.Add("</svg>\n");
  return std::move(svg).Take();
}

absl::StatusOr<std::string> SvgText(const Subject& subject, const view::ResultDocument& result) {
  BCCSKEL_ASSIGN_OR_RETURN(const view::DisplaySurface surface,
                           SurfaceOf(subject, kMostSvgTriangles));
  return SvgText({subject.title, result, surface, subject.result.skeleton_points, subject.context});
}

}  // namespace bccskel::exporting
