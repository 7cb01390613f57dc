#include "client/export/glb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "client/export/picture/display_curve.h"
#include "client/export/sampled_curve.h"
#include "client/export/text.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

// Sides of a tube in scenes with few and with many tubes.
constexpr size_t kSides = 8, kSidesOfMany = 4;
constexpr size_t kMany = 100'000;
constexpr int kFloat = 5126, kUint32 = 5125, kUint8 = 5121;          // component types
constexpr int kOfVertices = 34962, kOfCorners = 34963;               // buffer targets
constexpr size_t kMostBytes = std::numeric_limits<uint32_t>::max();  // of a file
constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

using Vector = std::array<float, 3>;

Vector Scaled(const Vector& v, float by) { return {v[0] * by, v[1] * by, v[2] * by}; }
Vector Added(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
float Product(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector Cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// The unit vector; (1, 0, 0) for the zero vector.
Vector Direction(const Vector& v) {
  const float length = std::sqrt(Product(v, v));
  return length > 0 ? Scaled(v, 1 / length) : Vector{1, 0, 0};
}

void AppendWord(std::string& bytes, uint32_t word) {
  std::array<char, 4> low_first;
  for (size_t n = 0; n < 4; ++n) low_first[n] = static_cast<char>(word >> 8 * n);
  bytes.append(low_first.data(), low_first.size());
}

struct Vertex {
  Vector position;
  Vector normal;
  uint32_t color;  // linear; r, g, b, a from the lowest byte on
};
constexpr size_t kVertexBytes = sizeof(Vertex);
static_assert(kVertexBytes == 28);

// Needs: items made of 4-byte words.
template <typename Item>
void AppendItems(std::string& bytes, const std::vector<Item>& items) {
  static_assert(sizeof(Item) % sizeof(uint32_t) == 0);
  const auto* const from = reinterpret_cast<const char*>(items.data());
  const size_t size = items.size() * sizeof(Item);
  if constexpr (std::endian::native == std::endian::little) {
    bytes.append(from, size);
  } else {
    for (size_t at = 0; at < size; at += sizeof(uint32_t)) {
      uint32_t word = 0;
      std::memcpy(&word, from + at, sizeof word);
      AppendWord(bytes, word);
    }
  }
}

bool IsFinite(const Vertex& vertex) {
  return std::ranges::all_of(vertex.position, [](float along) { return std::isfinite(along); });
}

// A closed surface around a curve: the center of a cap, rings of vertices, the center of the other
// cap.
struct Tube {
  std::vector<Vertex> vertices;
  size_t sides = 0;
};

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

// Of each node, counted from 0; none if the graph is of one object.
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

struct Turn {
  float cosine;
  float sine;
};
std::vector<Turn> TurnsOfRing(size_t tubes) {
  std::vector<Turn> turns(tubes > kMany ? kSidesOfMany : kSides);
  for (size_t k = 0; k < turns.size(); ++k) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(turns.size());
    turns[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return turns;
}

class TubeMaker {
 public:
  TubeMaker(const WorldPoint& center, const SkeletonGraph& graph, const GraphLabels& labels)
      : center_(center),
        range_(RadiusRangeOf(graph)),
        label_colors_(LabelColors(labels)),
        turns_(TurnsOfRing(graph.edges.size())) {}

  size_t sides() const { return turns_.size(); }

  // Rings that twist no more than the curve, and a cap at each end.
  Tube Around(const SkeletonEdge& edge, const std::vector<CurvePoint>& curve) const {
    Tube tube = {{}, turns_.size()};
    tube.vertices.reserve(2 + curve.size() * turns_.size());
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
      if (n + 1 == curve.size()) AddCap(curve[n], along, tube);
    }
    if (label_colors_.empty()) return tube;
    for (Vertex& vertex : tube.vertices) vertex.color = label_colors_[edge.source];
    return tube;
  }

 private:
  Vector PlaceOf(const CurvePoint& p) const {
    return {static_cast<float>(p.at[0] - center_[0]), static_cast<float>(p.at[1] - center_[1]),
            static_cast<float>(p.at[2] - center_[2])};
  }

  void AddVertex(const Vector& position, const Vector& normal, double radius, Tube& tube) const {
    const auto color = static_cast<size_t>(RadiusColorIndex(radius, range_));
    tube.vertices.push_back({position, normal, colors_[color]});
  }

  void AddCap(const CurvePoint& p, const Vector& normal, Tube& tube) const {
    AddVertex(PlaceOf(p), normal, p.radius, tube);
  }

  void AddRing(const CurvePoint& p, const Vector& side, const Vector& other, Tube& tube) const {
    for (const Turn& turn : turns_) {
      const Vector out = Added(Scaled(side, turn.cosine), Scaled(other, turn.sine));
      AddVertex(Added(PlaceOf(p), Scaled(out, static_cast<float>(p.radius))), out, p.radius, tube);
    }
  }

  const WorldPoint center_;
  const RadiusRange range_;
  const std::array<uint32_t, kRadiusColors> colors_ = RadiusColors();
  const std::vector<uint32_t> label_colors_;  // by node
  const std::vector<Turn> turns_;
};

// The triangles of a tube follow from the number of its vertices.
std::vector<uint32_t> CornersOf(const Tube& tube) {
  const auto ring = static_cast<uint32_t>(tube.sides);
  const auto last = static_cast<uint32_t>(tube.vertices.size() - 1);
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
  return corners;
}

// Builds the two chunks of the file.
class Scene {
 public:
  // Makes room for about this many vertices. Growing would copy most of a large file once more.
  Scene(size_t tubes, size_t vertices) {
    vertices_.reserve(std::min(vertices * kVertexBytes, kMostBytes));
    node_text_.Reserve(std::min(tubes * 160, kMostBytes));
    mesh_text_.Reserve(std::min(tubes * 130, kMostBytes));
    accessor_text_.Reserve(std::min(tubes * 440, kMostBytes));
  }

  void Add(const Tube& tube) {
    const size_t first_vertex = vertices_.size();
    Vector low = tube.vertices.front().position, high = low;
    for (const Vertex& vertex : tube.vertices) {
      for (size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], vertex.position[axis]);
        high[axis] = std::max(high[axis], vertex.position[axis]);
      }
    }
    AppendItems(vertices_, tube.vertices);
    const size_t count = tube.vertices.size();
    const size_t first = AddAccessor(kVertexView, first_vertex, kFloat, "VEC3", count);
    accessor_text_.Add(",\"min\":[", low[0], ',', low[1], ',', low[2], "],\"max\":[", high[0], ',',
                       high[1], ',', high[2], "]}");
    AddAccessor(kVertexView, first_vertex + 12, kFloat, "VEC3", count);
    accessor_text_.Add('}');
    AddAccessor(kVertexView, first_vertex + 24, kUint8, "VEC4", count);
    accessor_text_.Add(",\"normalized\":true}");
    const size_t corners = CornersAccessor(tube);
    mesh_text_.Add(meshes_ == 0 ? "\n" : ",\n",
                   "{\"primitives\":[{\"attributes\":{\"POSITION\":", first,
                   ",\"NORMAL\":", first + 1, ",\"COLOR_0\":", first + 2, "},\"indices\":", corners,
                   ",\"material\":0}]}");
    ++meshes_;
  }

  // Adds the node of the last mesh; node 0 is the root. Its figures are as precise as its vertices.
  void AddNode(std::string_view name, const EdgeFigures& figures) {
    const auto rounded = [](double figure) { return static_cast<float>(figure); };
    node_text_.Add(",\n{\"name\":\"", name, "\",\"mesh\":", meshes_ - 1,
                   ",\"extras\":{\"length\":", rounded(figures.length),
                   ",\"mean_radius\":", rounded(figures.mean_radius),
                   ",\"min_radius\":", rounded(figures.min_radius),
                   ",\"max_radius\":", rounded(figures.max_radius), "}}");
  }

  // Appends the JSON chunk and frees the texts that Add() and AddNode() have written: copies of
  // them all would take most of the memory and time of a large file.
  void MoveJsonTo(std::string& file, const WorldPoint& center, bool y_up) {
    Text text;
    text.Add("{\"asset\":{\"version\":\"2.0\",\"generator\":\"bccskel\"},\n\"scene\":0,\"scenes\":",
             "[{\"nodes\":[0]}],\n\"nodes\":[\n{\"name\":\"skeleton\",\"translation\":[");
    if (y_up) {
      text.Add(center[0], ',', center[1], ',', center[2], ']');
    } else {  // a quarter turn about x: z points up
      text.Add(center[0], ',', center[2], ',', -center[1],
               "],\"rotation\":[-0.7071067811865476,0,0,0.7071067811865476]");
    }
    if (meshes_ > 0) text.Add(",\"children\":[");
    for (size_t n = 1; n <= meshes_; ++n) text.Add(n == 1 ? "" : ",", n);
    text.Add(meshes_ > 0 ? "]}" : "}");
    file.reserve(file.size() + text.size() + node_text_.size() + mesh_text_.size() +
                 accessor_text_.size() + kRestOfJson + vertices_.size() + corners_.size());
    file += std::move(text).Take();
    file += std::move(node_text_).Take();
    file += "\n]";
    if (meshes_ > 0) MoveMeshesTo(file);
    file += "}\n";
  }
  const std::string& vertices() const { return vertices_; }
  const std::string& corners() const { return corners_; }

 private:
  static constexpr int kVertexView = 0, kCornerView = 1;
  static constexpr size_t kRestOfJson = 1024;  // at most, beside the texts, with the binary's head

  // Returns its number and leaves its JSON object open.
  size_t AddAccessor(int view, size_t offset, int type, std::string_view shape, size_t count) {
    accessor_text_.Add(accessors_ == 0 ? "\n" : ",\n", "{\"bufferView\":", view,
                       ",\"byteOffset\":", offset, ",\"componentType\":", type,
                       ",\"count\":", count, ",\"type\":\"", shape, '"');
    return accessors_++;
  }

  // Tubes with the same number of vertices share it.
  size_t CornersAccessor(const Tube& tube) {
    const auto [found, is_new] = corner_accessors_.emplace(tube.vertices.size(), accessors_);
    if (!is_new) return found->second;
    const std::vector<uint32_t> corners = CornersOf(tube);
    const size_t first = corners_.size();
    AppendItems(corners_, corners);
    AddAccessor(kCornerView, first, kUint32, "SCALAR", corners.size());
    accessor_text_.Add('}');
    return found->second;
  }

  void MoveMeshesTo(std::string& file) {
    file +=
        ",\n\"materials\":[{\"name\":\"radius\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
        "\"roughnessFactor\":0.6}}],\n\"meshes\":[";
    file += std::move(mesh_text_).Take();
    file += "\n],\n\"accessors\":[";
    file += std::move(accessor_text_).Take();
    Text text;
    text.Add("\n],\n\"bufferViews\":[\n{\"buffer\":0,\"byteLength\":", vertices_.size(),
             ",\"byteStride\":", kVertexBytes, ",\"target\":", kOfVertices,
             "},\n{\"buffer\":0,\"byteOffset\":", vertices_.size(),
             ",\"byteLength\":", corners_.size(), ",\"target\":", kOfCorners,
             "}\n],\n\"buffers\":[{\"byteLength\":", vertices_.size() + corners_.size(), "}]");
    file += std::move(text).Take();
  }

  std::string vertices_, corners_;
  Text node_text_, mesh_text_, accessor_text_;
  std::unordered_map<size_t, size_t> corner_accessors_;  // by the number of vertices
  size_t accessors_ = 0;
  size_t meshes_ = 0;
};

// Coordinates relative to it fit a float wherever the world's origin is.
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

constexpr size_t RoundedUp(size_t bytes) { return (bytes + 3) / 4 * 4; }

}  // namespace

absl::StatusOr<std::string> GlbBytes(const SkeletonGraph& graph, const GraphContext& context,
                                     const World& world) {
  const WorldPoint center = CenterOf(graph);
  const TubeMaker maker(center, graph, context.labels);
  // A curve has about as many samples as points; one more for caps.
  Scene scene(graph.edges.size(), maker.sides() * (graph.points.size() + graph.edges.size()));
  for (size_t n = 0; n < graph.edges.size() && !context.stop.stop_requested(); ++n) {
    const SkeletonEdge& edge = graph.edges[n];
    const std::vector<WorldPoint> smooth = SmoothCurve(graph, edge);
    const std::vector<CurvePoint> curve = SampledCurve(graph, edge, smooth);
    if (curve.empty()) continue;
    const Tube tube = maker.Around(edge, curve);
    if (!std::ranges::all_of(tube.vertices, IsFinite)) {
      return absl::InvalidArgumentError("the skeleton's coordinates do not fit a float32");
    }
    scene.Add(tube);
    scene.AddNode(BranchName(context.labels, n), FiguresOf(graph, edge, smooth));
  }
  constexpr size_t kHeads = 20;  // of the file and of the JSON chunk
  std::string file(kHeads, '\0');
  scene.MoveJsonTo(file, center, world.axes == kYUp);
  file.resize(RoundedUp(file.size()), ' ');
  const size_t json = file.size() - kHeads;
  const size_t binary = scene.vertices().size() + scene.corners().size();  // words alone
  if (binary > 0) {
    // Too long a chunk is an error below.
    AppendWord(file, static_cast<uint32_t>(binary));
    AppendWord(file, kBinary);
    file += scene.vertices();
    file += scene.corners();
  }
  if (file.size() > kMostBytes) {
    return absl::ResourceExhaustedError("GLB holds no more than 4 GiB");
  }
  std::string heads;
  for (const size_t word : {size_t{kMagic}, size_t{2}, file.size(), json, size_t{kJson}}) {
    AppendWord(heads, static_cast<uint32_t>(word));
  }
  file.replace(0, kHeads, heads);
  return file;
}

}  // namespace bccskel::exporting
