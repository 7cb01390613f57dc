#include "client/export/picture/html.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "client/export/node_kind_name.h"
#include "client/export/picture/caption.h"
#include "client/export/picture/png.h"
#include "client/export/picture/scene.h"
#include "client/export/picture/surface_points.h"
#include "client/export/picture/viewer_page.h"
#include "client/export/text.h"
#include "core/lattice/directions.h"

namespace bccskel::exporting {
namespace {

constexpr size_t kMostSurfacePoints = 50000;

// World coordinates as 16-bit integers: 32767 is the radius of the sphere around the box.
class Quantizer {
 public:
  explicit Quantizer(const WorldBox& box) {
    double square = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      center_[axis] = (box.low[axis] + box.high[axis]) / 2;
      const double half = (box.high[axis] - box.low[axis]) / 2;
      square += half * half;
    }
    const double radius = std::sqrt(square);
    steps_per_unit_ = radius > 0 ? 32767 / radius : 1;
  }

  double StepsOf(double length) const { return length * steps_per_unit_; }
  std::array<int16_t, 3> operator()(const WorldPoint& p) const {
    std::array<int16_t, 3> steps;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double step = std::round((p[axis] - center_[axis]) * steps_per_unit_);
      steps[axis] = static_cast<int16_t>(std::clamp(step, -32767.0, 32767.0));
    }
    return steps;
  }

 private:
  WorldPoint center_;
  double steps_per_unit_;
};

void AppendLittleEndian(std::string& bytes, const std::array<int16_t, 3>& values) {
  for (const int16_t value : values) {
    const auto bits = static_cast<uint16_t>(value);
    bytes.push_back(static_cast<char>(bits & 0xff));
    bytes.push_back(static_cast<char>(bits >> 8));
  }
}

// A part of the points, chosen without a pattern that the eye would see.
std::vector<LatticePoint> Thinned(const std::vector<LatticePoint>& points) {
  if (points.size() <= kMostSurfacePoints) return points;
  std::vector<LatticePoint> kept;
  const uint64_t threshold = (uint64_t{1} << 32) * kMostSurfacePoints / points.size();
  for (const LatticePoint p : points) {
    uint64_t mixed = static_cast<uint32_t>(p.x) * 0x9e3779b97f4a7c15u;
    mixed = (std::rotl(mixed, 23) ^ static_cast<uint32_t>(p.y)) * 0xbf58476d1ce4e5b9u;
    mixed = (std::rotl(mixed, 23) ^ static_cast<uint32_t>(p.z)) * 0x94d049bb133111ebu;
    if (mixed >> 32 < threshold) kept.push_back(p);
  }
  return kept;
}

// Points away from the object, as signed bytes: the sum of the steps that lead out of it.
std::array<char, 3> NormalAt(const Volume& object, LatticePoint p) {
  constexpr int kReach = 5;
  std::array<double, 3> sum = {};
  for (const LatticePoint d : kDirections14) {
    for (int step = 1; step <= kReach; ++step) {
      if (object.Contains({p.x + step * d.x, p.y + step * d.y, p.z + step * d.z})) continue;
      sum[0] += d.x;
      sum[1] += d.y;
      sum[2] += d.z;
    }
  }
  const Placement& placement = object.placement();
  const WorldPoint tip = placement.ToWorld(sum[0], sum[1], sum[2]);
  WorldPoint normal;
  for (size_t axis = 0; axis < 3; ++axis) normal[axis] = tip[axis] - placement.origin[axis];
  const double length =
      std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  std::array<char, 3> bytes = {};
  for (size_t axis = 0; axis < 3 && length > 0; ++axis) {
    bytes[axis] = static_cast<char>(std::lround(127 * normal[axis] / length));
  }
  return bytes;
}

void AddSurface(Text& json, const Scene& scene, const Volume& object, const Quantizer& quantize) {
  std::string positions, normals;
  const std::vector<LatticePoint> surface = SurfacePoints(object);
  const std::vector<LatticePoint> points = Thinned(surface);
  for (const LatticePoint p : points) {
    AppendLittleEndian(positions, quantize(object.placement().ToWorld(p)));
    const std::array<char, 3> normal = NormalAt(object, p);
    normals.append(normal.data(), normal.size());
  }
  // Fewer points must be larger to cover the same surface.
  const double share =
      points.empty() ? 1 : static_cast<double>(surface.size()) / static_cast<double>(points.size());
  json.Add("\"spacing\":", quantize.StepsOf(scene.point_spacing) * std::sqrt(share),
           ",\n\"surface\":\"", EncodeBase64(positions), "\",\n\"normals\":\"",
           EncodeBase64(normals), "\"");
}

void AddCurve(Text& json, const DisplayCurve& curve, const RadiusRange& radii,
              const Quantizer& quantize) {
  std::string positions, colors;
  for (size_t n = 0; n < curve.points.size(); ++n) {
    AppendLittleEndian(positions, quantize(curve.points[n]));
    colors.push_back(static_cast<char>(RadiusColorIndex(curve.radii[n], radii)));
  }
  json.Add("{\"points\":\"", EncodeBase64(positions), "\",\"colors\":\"", EncodeBase64(colors),
           "\"}");
}

void AddNode(Text& json, const SkeletonGraph& graph, const SkeletonNode& node,
             const Quantizer& quantize) {
  const std::array<int16_t, 3> p = quantize(graph.PositionOf(node.at));
  json.Add("{\"kind\":\"", NodeKindName(node.kind), "\",\"position\":[", p[0], ',', p[1], ',', p[2],
           "]}");
}

void AddView(Text& json, const View& view) {
  std::string_view separator = "[";
  for (const WorldPoint& row : {view.right, view.up, view.toward}) {
    json.Add(separator, '[', row[0], ',', row[1], ',', row[2], ']');
    separator = ",";
  }
  json.Add(']');
}

std::string DataOf(const Subject& subject) {
  const Scene scene = SceneOf(subject);
  const Quantizer quantize(scene.box);
  const SkeletonGraph& graph = subject.result.graph;
  Text json;
  json.Add("{\"view\":");
  AddView(json, ViewsOf(scene.box).front());
  json.Add(",\n\"colors\":[");
  for (int n = 0; n < kRadiusColors; ++n) json.Add(n > 0 ? "," : "", '"', RadiusColor(n), '"');
  json.Add("],\n\"curves\":[");
  for (size_t n = 0; n < scene.curves.size(); ++n) {
    json.Add(n > 0 ? ",\n" : "");
    AddCurve(json, scene.curves[n], scene.radii, quantize);
  }
  json.Add("],\n\"nodes\":[");
  for (size_t n = 0; n < graph.nodes.size(); ++n) {
    json.Add(n > 0 ? ",\n" : "");
    AddNode(json, graph, graph.nodes[n], quantize);
  }
  json.Add("],\n");
  AddSurface(json, scene, subject.object, quantize);
  json.Add('}');
  return std::move(json).Take();
}

// What stands for a {{word}} of the page.
std::string ValueOf(std::string_view word, const Subject& subject) {
  if (word == "title") return EscapeMarkup(subject.title);
  if (word == "object") return EscapeMarkup(ObjectPhrase(subject.result));
  if (word == "skeleton") return EscapeMarkup(SkeletonPhrase(subject.result));
  return DataOf(subject);
}

}  // namespace

std::string HtmlText(const Subject& subject) {
  Text page;
  std::string_view rest = kViewerPage;
  for (size_t open = rest.find("{{"); open != rest.npos; open = rest.find("{{")) {
    const size_t close = rest.find("}}", open);
    page.Add(rest.substr(0, open), ValueOf(rest.substr(open + 2, close - open - 2), subject));
    rest.remove_prefix(close + 2);
  }
  page.Add(rest);
  return std::move(page).Take();
}

}  // namespace bccskel::exporting
