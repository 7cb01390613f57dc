#include "client/export/picture/beads.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bccskel::exporting {
namespace {

Bead BeadAt(const PanelPoint& p, double radius, const LinearColor& color) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.depth),
          static_cast<float>(radius), color};
}

PanelPoint Between(const PanelPoint& a, const PanelPoint& b, double part) {
  return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.depth + part * (b.depth - a.depth)};
}

class Stringer {
 public:
  Stringer(const view::ResultDocument& result, const Projection& projection, double thickness)
      : projection_(projection),
        thickness_(thickness),
        colors_(result),
        step_(projection.scale() * LengthOf(result) > kMany ? std::max(1.0, thickness) : 1) {
    beads_.reserve(MostBeads(result));
  }

  void AddEdge(const view::ResultDocument::Edge& edge) {
    const std::vector<WorldPoint> curve = SmoothedForDisplay(edge.points);
    for (size_t n = 1; n < curve.size(); ++n) {
      const PanelPoint from = projection_.Project(curve[n - 1]), to = projection_.Project(curve[n]);
      const int steps = 1 + static_cast<int>(std::hypot(to.x - from.x, to.y - from.y) / step_);
      for (int step = 0; step < steps; ++step) {
        const double part = static_cast<double>(step) / steps;
        const double radius = edge.radii[n - 1] + part * (edge.radii[n] - edge.radii[n - 1]);
        beads_.push_back(BeadAt(Between(from, to, part), thickness_,
                                LinearOf(colors_.Rgb(colors_.NumberAt(edge, radius)))));
      }
    }
  }

  void AddNode(const view::ResultDocument::Node& node) {
    if (node.kind == "loop") return;  // represents its curve only
    const LinearColor& color = node.kind == "end"        ? kEndColor
                               : node.kind == "junction" ? kJunctionColor
                                                         : kOtherColor;
    beads_.push_back(BeadAt(projection_.Project(node.position), 1.9 * thickness_, color));
  }

  std::vector<Bead> Take() && { return std::move(beads_); }

 private:
  // A bead per unit, but one per radius where there are very many: the notches between them are
  // then still far below a pixel.
  static constexpr double kMany = 4e6;
  static double LengthOf(const view::ResultDocument& result) {
    double length = 0;
    for (const view::ResultDocument::Edge& edge : result.edges) length += edge.length;
    return length;
  }

  // By the points: documents may state any length.
  size_t MostBeads(const view::ResultDocument& result) const {
    size_t most = result.nodes.size();
    double length = 0;
    for (const view::ResultDocument::Edge& edge : result.edges) {
      most += edge.points.size();
      for (size_t n = 1; n < edge.points.size(); ++n) {
        const WorldPoint &a = edge.points[n - 1], &b = edge.points[n];
        length += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      }
    }
    return most + static_cast<size_t>(projection_.scale() * length / step_);
  }

  const Projection& projection_;
  const double thickness_;
  const CurveColors colors_;
  const double step_;
  std::vector<Bead> beads_;
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
  for (const view::ResultDocument::Edge& edge : result.edges)
    std::ranges::for_each(edge.radii, include);
  std::ranges::for_each(result.sheets.radii, include);
  return range;
}

std::vector<Bead> BeadsOf(const view::ResultDocument& result, const Projection& projection,
                          double thickness) {
  Stringer stringer(result, projection, thickness);
  for (const view::ResultDocument::Edge& edge : result.edges) stringer.AddEdge(edge);
  for (const view::ResultDocument::Node& node : result.nodes) stringer.AddNode(node);
  return std::move(stringer).Take();
}

}  // namespace bccskel::exporting
