#include "client/export/tube.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bccskel::exporting {
namespace {

// Sides of a tube in scenes with few and with many tubes.
constexpr size_t kSides = 8, kSidesOfMany = 4;
constexpr size_t kMany = 100'000;

using Vector = std::array<float, 3>;

Vector Scaled(const Vector& v, float by) { return {v[0] * by, v[1] * by, v[2] * by}; }
Vector Added(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
// The unit vector; (1, 0, 0) for the zero vector.
Vector Direction(const Vector& v) {
  const float length = LengthOf(v);
  return length > 0 ? Scaled(v, 1 / length) : Vector{1, 0, 0};
}

// glTF's colors are linear.
uint32_t PackedColor(const std::array<double, 3>& rgb) {
  uint32_t color = 0xff000000;
  int shift = 0;
  for (const double part : rgb) {
    color |= static_cast<uint32_t>(std::lround(255 * std::pow(part / 255, 2.2))) << shift;
    shift += 8;
  }
  return color;
}
std::array<uint32_t, kRadiusColors> RadiusColors() {
  std::array<uint32_t, kRadiusColors> colors;
  for (size_t n = 0; n < colors.size(); ++n)
    colors[n] = PackedColor(RadiusRgb(static_cast<int>(n)));
  return colors;
}

std::vector<uint32_t> LabelColors(const GraphLabels& labels) {
  std::vector<uint32_t> of_names;
  for (uint32_t place = 0; place < labels.names.size(); ++place) {
    of_names.push_back(PackedColor(LabelRgb(place)));
  }
  std::vector<uint32_t> colors;
  for (const uint32_t place : PlacesOf(labels.of_nodes, labels.names)) {
    colors.push_back(of_names[place]);
  }
  return colors;
}

}  // namespace

bool Tube::IsFinite() const {
  return std::ranges::all_of(vertices, [](const TubeVertex& vertex) {
    return std::ranges::all_of(vertex.position, [](float along) { return std::isfinite(along); });
  });
}

std::vector<uint32_t> Tube::Corners(uint32_t first_vertex) const {
  const auto ring = static_cast<uint32_t>(sides);
  const auto last = static_cast<uint32_t>(vertices.size() - 1);
  std::vector<uint32_t> corners;
  for (uint32_t first = 1 + ring; first < last; first += ring) {
    for (uint32_t k = 0; k < ring; ++k) {
      const uint32_t a = first + k, b = first + (k + 1) % ring;
      corners.insert(corners.end(), {a - ring, b - ring, b, a - ring, b, a});
    }
  }
  for (uint32_t k = 0; k < ring; ++k) {
    const uint32_t next = (k + 1) % ring;
    corners.insert(corners.end(), {0, 1 + next, 1 + k, last, last - ring + k, last - ring + next});
  }
  for (uint32_t& corner : corners) corner += first_vertex;
  return corners;
}

TubeMaker::TubeMaker(const WorldPoint& center, const SkeletonGraph& graph,
                     const GraphLabels& labels)
    : center_(center),
      range_(RadiusRangeOf(graph)),
      colors_(RadiusColors()),
      label_colors_(LabelColors(labels)),
      turns_(TurnsOfRing(graph.edges.size())) {}

std::vector<TubeMaker::Turn> TubeMaker::TurnsOfRing(size_t tubes) {
  std::vector<Turn> turns(tubes > kMany ? kSidesOfMany : kSides);
  for (size_t k = 0; k < turns.size(); ++k) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(turns.size());
    turns[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return turns;
}

Tube TubeMaker::Around(const SkeletonEdge& edge, const std::vector<CurvePoint>& curve) const {
  Tube tube = {{}, turns_.size()};
  if (curve.empty()) return tube;
  tube.vertices.reserve(2 + curve.size() * turns_.size());
  Vector side = {0.36f, 0.48f, 0.8f};
  for (size_t n = 0; n < curve.size(); ++n) {
    const Vector before = PlaceOf(curve[n == 0 ? 0 : n - 1]);
    const Vector after = PlaceOf(curve[std::min(n + 1, curve.size() - 1)]);
    const Vector along = Direction(Added(after, Scaled(before, -1)));
    side = Added(side, Scaled(along, -Dot(side, along)));
    if (Dot(side, side) < 1e-8f) side = Cross({along[1], along[2], -along[0]}, along);
    side = Direction(side);
    if (n == 0) AddVertex(PlaceOf(curve[n]), Scaled(along, -1), curve[n].radius, tube);
    AddRing(curve[n], side, Cross(along, side), tube);
    if (n + 1 == curve.size()) AddVertex(PlaceOf(curve[n]), along, curve[n].radius, tube);
  }
  if (label_colors_.empty()) return tube;
  for (TubeVertex& vertex : tube.vertices) vertex.color = label_colors_[edge.source];
  return tube;
}

TubeMaker::Vector TubeMaker::PlaceOf(const CurvePoint& p) const {
  return {static_cast<float>(p.at[0] - center_[0]), static_cast<float>(p.at[1] - center_[1]),
          static_cast<float>(p.at[2] - center_[2])};
}

void TubeMaker::AddVertex(const Vector& position, const Vector& normal, double radius,
                          Tube& tube) const {
  const auto color = static_cast<size_t>(RadiusColorIndex(radius, range_));
  tube.vertices.push_back({position, normal, colors_[color]});
}

void TubeMaker::AddRing(const CurvePoint& p, const Vector& side, const Vector& other,
                        Tube& tube) const {
  for (const Turn& turn : turns_) {
    const Vector out = Added(Scaled(side, turn.cosine), Scaled(other, turn.sine));
    AddVertex(Added(PlaceOf(p), Scaled(out, static_cast<float>(p.radius))), out, p.radius, tube);
  }
}

}  // namespace bccskel::exporting
