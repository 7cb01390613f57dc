#include "client/export/glb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "client/export/branch_name.h"
#include "client/export/picture/display_curve.h"
#include "client/export/sampled_curve.h"
#include "client/export/text.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

constexpr size_t kSides = 8;                                 // of a tube
constexpr int kFloat = 5126, kUint32 = 5125, kUint8 = 5121;  // component types
constexpr int kOfVertices = 34962, kOfCorners = 34963;       // buffer targets
constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

using Vector = std::array<float, 3>;

Vector Scaled(const Vector& v, float by) { return {v[0] * by, v[1] * by, v[2] * by}; }
Vector Added(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
float Product(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector Cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// Of length 1; (1, 0, 0) for zero.
Vector Direction(const Vector& v) {
  const float length = std::sqrt(Product(v, v));
  return length > 0 ? Scaled(v, 1 / length) : Vector{1, 0, 0};
}

void AppendWord(std::string& bytes, uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(word >> shift));
}
void AppendVector(std::string& bytes, const Vector& v) {
  for (const float part : v) AppendWord(bytes, std::bit_cast<uint32_t>(part));
}

// A closed surface around a curve.
struct Tube {
  std::vector<Vector> positions;
  std::vector<Vector> normals;
  std::vector<uint32_t> colors;  // r, g, b, a from the lowest byte on; linear
  std::vector<uint32_t> corners;
};

// glTF's colors are linear.
uint32_t ColorOf(double radius, const RadiusRange& range) {
  uint32_t color = 0xff000000;
  int shift = 0;
  for (const double part : RadiusRgb(RadiusColorIndex(radius, range))) {
    color |= static_cast<uint32_t>(std::lround(255 * std::pow(part / 255, 2.2))) << shift;
    shift += 8;
  }
  return color;
}

class TubeMaker {
 public:
  TubeMaker(const WorldPoint& center, const RadiusRange& range) : center_(center), range_(range) {}

  // Rings that turn no more than the curve does, and a cap at either end.
  Tube Around(const std::vector<CurvePoint>& curve) const {
    Tube tube;
    Vector side = {0.36f, 0.48f, 0.8f};
    for (size_t n = 0; n < curve.size(); ++n) {
      const Vector before = PlaceOf(curve[n == 0 ? 0 : n - 1]);
      const Vector after = PlaceOf(curve[std::min(n + 1, curve.size() - 1)]);
      const Vector along = Direction(Added(after, Scaled(before, -1)));
      side = Added(side, Scaled(along, -Product(side, along)));
      if (Product(side, side) < 1e-8f) side = Cross({along[1], along[2], -along[0]}, along);
      side = Direction(side);
      if (n == 0) AddCap(curve[n], Scaled(along, -1), tube);
      AddRing(curve[n], side, Cross(along, side), tube);
      if (n > 0) JoinRings(tube);
      if (n + 1 == curve.size()) AddCap(curve[n], along, tube);
    }
    CloseCaps(curve.size(), tube);
    return tube;
  }

 private:
  Vector PlaceOf(const CurvePoint& p) const {
    return {static_cast<float>(p.at[0] - center_[0]), static_cast<float>(p.at[1] - center_[1]),
            static_cast<float>(p.at[2] - center_[2])};
  }

  void AddVertex(const Vector& position, const Vector& normal, double radius, Tube& tube) const {
    tube.positions.push_back(position);
    tube.normals.push_back(normal);
    tube.colors.push_back(ColorOf(radius, range_));
  }

  void AddCap(const CurvePoint& p, const Vector& normal, Tube& tube) const {
    AddVertex(PlaceOf(p), normal, p.radius, tube);
  }

  void AddRing(const CurvePoint& p, const Vector& side, const Vector& other, Tube& tube) const {
    for (size_t k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / kSides;
      const Vector out = Added(Scaled(side, static_cast<float>(std::cos(angle))),
                               Scaled(other, static_cast<float>(std::sin(angle))));
      AddVertex(Added(PlaceOf(p), Scaled(out, static_cast<float>(p.radius))), out, p.radius, tube);
    }
  }

  // The last two.
  static void JoinRings(Tube& tube) {
    const auto last = static_cast<uint32_t>(tube.positions.size() - kSides);
    for (uint32_t k = 0; k < kSides; ++k) {
      const uint32_t a = last + k, b = last + (k + 1) % kSides;
      const auto ring = static_cast<uint32_t>(kSides);
      tube.corners.insert(tube.corners.end(), {a - ring, b - ring, b, a - ring, b, a});
    }
  }

  // Needs: the caps' centers are the first and the last vertex.
  static void CloseCaps(size_t rings, Tube& tube) {
    if (rings == 0) return;
    const auto last = static_cast<uint32_t>(tube.positions.size() - 1);
    const auto last_ring = static_cast<uint32_t>(last - kSides);
    for (uint32_t k = 0; k < kSides; ++k) {
      const uint32_t next = (k + 1) % kSides;
      tube.corners.insert(tube.corners.end(),
                          {0, 1 + next, 1 + k, last, last_ring + k, last_ring + next});
    }
  }

  const WorldPoint center_;
  const RadiusRange range_;
};

// The two chunks of the file while they grow.
class Scene {
 public:
  void Add(const Tube& tube) {
    const size_t first_accessor = accessors_;
    Vector low = tube.positions.front(), high = low;
    for (const Vector& p : tube.positions) {
      for (size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
      AppendVector(binary_, p);
    }
    AddAccessor(kFloat, "VEC3", tube.positions.size(), kOfVertices);
    accessor_text_.Add(",\"min\":[", low[0], ',', low[1], ',', low[2], "],\"max\":[", high[0], ',',
                       high[1], ',', high[2], "]}");
    for (const Vector& normal : tube.normals) AppendVector(binary_, normal);
    AddAccessor(kFloat, "VEC3", tube.normals.size(), kOfVertices);
    accessor_text_.Add('}');
    for (const uint32_t color : tube.colors) AppendWord(binary_, color);
    AddAccessor(kUint8, "VEC4", tube.colors.size(), kOfVertices);
    accessor_text_.Add(",\"normalized\":true}");
    for (const uint32_t corner : tube.corners) AppendWord(binary_, corner);
    AddAccessor(kUint32, "SCALAR", tube.corners.size(), kOfCorners);
    accessor_text_.Add('}');
    mesh_text_.Add(meshes_ == 0 ? "\n" : ",\n",
                   "{\"primitives\":[{\"attributes\":{\"POSITION\":", first_accessor,
                   ",\"NORMAL\":", first_accessor + 1, ",\"COLOR_0\":", first_accessor + 2,
                   "},\"indices\":", first_accessor + 3, ",\"material\":0}]}");
    ++meshes_;
  }

  // The node of the last mesh; node 0 is the root.
  void AddNode(std::string_view name, const EdgeFigures& figures) {
    node_text_.Add(",\n{\"name\":\"", name, "\",\"mesh\":", meshes_ - 1,
                   ",\"extras\":{\"length\":", figures.length,
                   ",\"mean_radius\":", figures.mean_radius, ",\"min_radius\":", figures.min_radius,
                   ",\"max_radius\":", figures.max_radius, "}}");
  }

  std::string Json(const WorldPoint& center) && {
    Text text;
    text.Add("{\"asset\":{\"version\":\"2.0\",\"generator\":\"bccskel\"},\n\"scene\":0,\"scenes\":",
             "[{\"nodes\":[0]}],\n\"nodes\":[\n{\"name\":\"skeleton\",\"translation\":[", center[0],
             ',', center[2], ',', -center[1],
             // A quarter turn about x: z goes up.
             "],\"rotation\":[-0.7071067811865476,0,0,0.7071067811865476]");
    if (meshes_ > 0) text.Add(",\"children\":[");
    for (size_t n = 1; n <= meshes_; ++n) text.Add(n == 1 ? "" : ",", n);
    text.Add(meshes_ > 0 ? "]}" : "}", std::move(node_text_).Take(), "\n]");
    if (meshes_ > 0) {
      text.Add(
          ",\n\"materials\":[{\"name\":\"radius\",\"pbrMetallicRoughness\":{\"metallicFactor\":",
          "0,\"roughnessFactor\":0.6}}],\n\"meshes\":[", std::move(mesh_text_).Take(),
          "\n],\n\"accessors\":[", std::move(accessor_text_).Take(), "\n],\n\"bufferViews\":[",
          std::move(view_text_).Take(), "\n],\n\"buffers\":[{\"byteLength\":", binary_.size(),
          "}]");
    }
    text.Add("}\n");
    return std::move(text).Take();
  }
  const std::string& binary() const { return binary_; }

 private:
  // Of what was appended last; its JSON object is left open.
  void AddAccessor(int type, std::string_view shape, size_t count, int target) {
    view_text_.Add(accessors_ == 0 ? "\n" : ",\n", "{\"buffer\":0,\"byteOffset\":", viewed_,
                   ",\"byteLength\":", binary_.size() - viewed_, ",\"target\":", target, '}');
    viewed_ = binary_.size();
    accessor_text_.Add(accessors_ == 0 ? "\n" : ",\n", "{\"bufferView\":", accessors_,
                       ",\"componentType\":", type, ",\"count\":", count, ",\"type\":\"", shape,
                       '"');
    ++accessors_;
  }

  std::string binary_;
  Text node_text_, mesh_text_, accessor_text_, view_text_;
  size_t accessors_ = 0, meshes_ = 0;
  size_t viewed_ = 0;  // bytes of binary_ that views cover
};

// Coordinates around it fit a float wherever the world's origin is.
WorldPoint CenterOf(const SkeletonGraph& graph) {
  WorldPoint sum = {0, 0, 0};
  for (const SkeletonNode& node : graph.nodes) {
    const WorldPoint p = graph.PositionOf(node.at);
    for (size_t axis = 0; axis < 3; ++axis) {
      sum[axis] += p[axis] / static_cast<double>(graph.nodes.size());
    }
  }
  return sum;
}

void AppendChunk(std::string& file, uint32_t type, std::string chunk, char filler) {
  chunk.resize((chunk.size() + 3) / 4 * 4, filler);
  AppendWord(file, static_cast<uint32_t>(chunk.size()));
  AppendWord(file, type);
  file += chunk;
}

}  // namespace

absl::StatusOr<std::string> GlbBytes(const SkeletonGraph& graph, const GraphContext& context) {
  const WorldPoint center = CenterOf(graph);
  const TubeMaker maker(center, RadiusRangeOf(graph));
  Scene scene;
  for (size_t n = 0; n < graph.edges.size(); ++n) {
    const std::vector<CurvePoint> curve = SampledCurve(graph, graph.edges[n]);
    if (curve.empty()) continue;
    scene.Add(maker.Around(curve));
    scene.AddNode(BranchName(context.labels, n), FiguresOf(graph, graph.edges[n]));
  }
  std::string binary = scene.binary();
  const std::string json = std::move(scene).Json(center);
  constexpr size_t kHeads = 12 + 8 + 8 + 6;  // with the fillers
  if (json.size() + binary.size() + kHeads > std::numeric_limits<uint32_t>::max()) {
    return absl::ResourceExhaustedError("GLB holds no more than 4 GiB");
  }
  std::string chunks;
  AppendChunk(chunks, kJson, json, ' ');
  if (!binary.empty()) AppendChunk(chunks, kBinary, std::move(binary), '\0');
  std::string file;
  AppendWord(file, kMagic);
  AppendWord(file, 2);
  AppendWord(file, static_cast<uint32_t>(12 + chunks.size()));
  return file + chunks;
}

}  // namespace bccskel::exporting
