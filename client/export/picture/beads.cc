#include "client/export/picture/beads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "client/view/display_curve.h"
#include "core/exec/status_macros.h"

namespace bccskel::exporting {
namespace {

Bead BeadAt(const PanelPoint& p, double radius, const LinearColor& color) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.depth),
          static_cast<float>(radius), color};
}

PanelPoint Between(const PanelPoint& a, const PanelPoint& b, double part) {
  return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.depth + part * (b.depth - a.depth)};
}

constexpr size_t kAtOnce = 2048;  // edges and nodes

// A bead per unit, but one per radius where there are very many: the notches between them are then
// still far below a pixel.
constexpr double kMany = 4e6;

// One view.
struct Stringer {
  const CurveColors& colors;
  const Projection& projection;
  double thickness;
  double step;

  // Needs: `curve` and `radii` have an item for each point of the edge.
  void AddEdge(const view::ResultDocument::Edge& edge, std::span<const WorldPoint> curve,
               std::span<const double> radii, std::vector<Bead>& beads) const {
    if (curve.empty()) return;
    PanelPoint to = projection.Project(curve.front());
    for (size_t n = 1; n < curve.size(); ++n) {
      const PanelPoint from = std::exchange(to, projection.Project(curve[n]));
      const double dx = to.x - from.x, dy = to.y - from.y;
      const int steps = 1 + static_cast<int>(std::sqrt(dx * dx + dy * dy) / step);
      for (int k = 0; k < steps; ++k) {
        const double part = static_cast<double>(k) / steps;
        const double radius = radii[n - 1] + part * (radii[n] - radii[n - 1]);
        beads.push_back(BeadAt(Between(from, to, part), thickness,
                               colors.Linear(colors.NumberAt(edge, radius))));
      }
    }
  }

  void AddNode(const view::ResultDocument::Node& node, std::vector<Bead>& beads) const {
    if (node.kind == "loop") return;  // represents its curve only
    const LinearColor& color = node.kind == "end"        ? kEndColor
                               : node.kind == "junction" ? kJunctionColor
                                                         : kOtherColor;
    beads.push_back(BeadAt(projection.Project(node.position), 1.9 * thickness, color));
  }
};

}  // namespace

LinearColor LinearOf(const std::array<double, 3>& rgb) {
  return {static_cast<float>(rgb[0] / 255), static_cast<float>(rgb[1] / 255),
          static_cast<float>(rgb[2] / 255)};
}

const view::ResultDocument::Labels CurveColors::kNoLabels;

CurveColors::CurveColors(const view::ResultDocument& result)
    : labels_(result.labels.has_value() ? *result.labels : kNoLabels),
      sheets_(result.sheets),
      range_(RadiusRangeOf(result)) {
  const size_t count = labeled() ? labels_.names.size() : size_t{kRadiusColors};
  for (size_t n = 0; n < count; ++n) {
    colors_.push_back(labeled() ? LabelRgb(static_cast<uint32_t>(n))
                                : RadiusRgb(static_cast<int>(n)));
    linear_.push_back(LinearOf(colors_.back()));
  }
}

RadiusRange RadiusRangeOf(const view::ResultDocument& result) {
  if (result.nodes.empty()) return {0, 0};
  RadiusRange range = {result.nodes.front().radius, result.nodes.front().radius};
  const auto include = [&](double radius) {
    range.low = std::min(range.low, radius);
    range.high = std::max(range.high, radius);
  };
  for (const view::ResultDocument::Node& node : result.nodes) include(node.radius);
  std::ranges::for_each(result.radii, include);
  std::ranges::for_each(result.sheets.radii, include);
  return range;
}

BeadStrings::BeadStrings(const view::ResultDocument& result) : result_(result), colors_(result) {
  for (const view::ResultDocument::Edge& edge : result.edges) length_ += edge.length;
}

absl::StatusOr<BeadStrings> BeadStrings::Of(const view::ResultDocument& result,
                                            const exec::Context& context) {
  BeadStrings strings(result);
  BCCSKEL_ASSIGN_OR_RETURN(strings.curves_, view::DisplayCurvesOf(result, context));
  return strings;
}

absl::StatusOr<Beads> BeadStrings::In(const Projection& projection, double thickness,
                                      const exec::Context& context) const {
  const bool many = projection.scale() * length_ > kMany;
  const Stringer stringer = {colors_, projection, thickness, many ? std::max(1.0, thickness) : 1};
  const size_t edges = result_.edges.size(), count = edges + result_.nodes.size();
  Beads beads((count + kAtOnce - 1) / kAtOnce);
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(count, kAtOnce, [&](exec::Share share) {
    std::vector<Bead>& part = beads[share.begin / kAtOnce];
    for (size_t n = share.begin; n < share.end; ++n) {
      if (n < edges) {
        const view::ResultDocument::Edge& edge = result_.edges[n];
        stringer.AddEdge(edge, CurveOf(edge), result_.RadiiOf(edge), part);
      } else {
        stringer.AddNode(result_.nodes[n - edges], part);
      }
    }
  }));
  return beads;
}

}  // namespace bccskel::exporting
