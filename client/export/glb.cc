#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "client/export/graph_formats.h"
#include "client/export/picture/escape.h"
#include "client/export/sampled_curve.h"
#include "client/export/text.h"
#include "client/export/tube.h"
#include "core/exec/status_macros.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

// Programs that show glTF take long for many meshes: more tubes than this are one mesh.
constexpr size_t kMostMeshes = 20'000;
constexpr int kFloat = 5126, kUint32 = 5125, kUint8 = 5121;          // component types
constexpr int kOfVertices = 34962, kOfCorners = 34963;               // buffer targets
constexpr size_t kMostBytes = std::numeric_limits<uint32_t>::max();  // of a file
constexpr size_t kHeads = 20;  // bytes of the heads of the file and of the JSON chunk
constexpr size_t kChunkHead = 8;
constexpr size_t kVertexBytes = sizeof(TubeVertex);
static_assert(kVertexBytes == 28);
constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

void AppendWord(std::string& bytes, uint32_t word) {
  std::array<char, 4> low_first;
  for (size_t n = 0; n < 4; ++n) low_first[n] = static_cast<char>(word >> 8 * n);
  bytes.append(low_first.data(), low_first.size());
}

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

// The extent of vertices.
struct Box {
  std::array<float, 3> low, high;

  void Include(const Tube& tube) {
    for (const TubeVertex& vertex : tube.vertices) {
      for (size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], vertex.position[axis]);
        high[axis] = std::max(high[axis], vertex.position[axis]);
      }
    }
  }
  static Box Of(const Tube& tube) {
    Box box = {tube.vertices.front().position, tube.vertices.front().position};
    box.Include(tube);
    return box;
  }
};

// Builds the two chunks of the file.
class Scene {
 public:
  // Makes room for about this many vertices. Growing would copy most of a large file once more.
  Scene(size_t tubes, size_t vertices) : joined_(tubes > kMostMeshes) {
    const size_t corners = joined_ ? 6 * vertices * sizeof(uint32_t) : 0;
    vertices_.reserve(
        std::min(kHeads + kChunkHead + vertices * kVertexBytes + corners, kMostBytes));
    corners_.reserve(std::min(corners, kMostBytes));
  }

  // A mesh of its own, or a part of the only one.
  void Add(const Tube& tube) {
    const size_t first = vertices_.size() / kVertexBytes;
    AppendItems(vertices_, tube.vertices);
    if (joined_) {
      AppendItems(corners_, tube.Corners(static_cast<uint32_t>(first)));
      if (!box_) box_ = Box::Of(tube);
      box_->Include(tube);
      return;
    }
    AddMesh(first, tube.vertices.size(), Box::Of(tube), [&] { return CornersAccessor(tube); });
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

  // The file, as soon as all tubes are there. The vertices are most of a large one and make room in
  // place: copies take more time than all computing.
  absl::StatusOr<std::string> File(const WorldPoint& center, bool y_up,
                                   const MethodFacts& facts) && {
    if (box_) {
      AddMesh(0, vertices_.size() / kVertexBytes, *box_,
              [&] { return AddCorners(0, corners_.size() / sizeof(uint32_t)); });
      node_text_.Add(",\n{\"name\":\"branches\",\"mesh\":0}");
    }
    std::string json = Json(center, y_up, facts);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const size_t binary = vertices_.size() + corners_.size();  // words alone
    const size_t size = kHeads + json.size() + (binary > 0 ? kChunkHead + binary : 0);
    if (size > kMostBytes) return absl::ResourceExhaustedError("GLB holds no more than 4 GiB");
    std::string head;
    for (const size_t word : {size_t{kMagic}, size_t{2}, size, json.size(), size_t{kJson}}) {
      AppendWord(head, static_cast<uint32_t>(word));
    }
    head += json;
    if (binary > 0) {
      AppendWord(head, static_cast<uint32_t>(binary));
      AppendWord(head, kBinary);
    }
    vertices_.reserve(size);
    vertices_.insert(0, head);
    vertices_ += corners_;
    return std::move(vertices_);
  }
  bool joined() const { return joined_; }

 private:
  static constexpr int kVertexView = 0, kCornerView = 1;

  // `add_corners()` returns the number of their accessor.
  template <typename AddCorners>
  void AddMesh(size_t first_vertex, size_t count, const Box& box, AddCorners add_corners) {
    const size_t offset = first_vertex * kVertexBytes;
    const size_t first = AddAccessor(kVertexView, offset, kFloat, "VEC3", count);
    const auto& [low, high] = box;
    accessor_text_.Add(",\"min\":[", low[0], ',', low[1], ',', low[2], "],\"max\":[", high[0], ',',
                       high[1], ',', high[2], "]}");
    AddAccessor(kVertexView, offset + 12, kFloat, "VEC3", count);
    accessor_text_.Add('}');
    AddAccessor(kVertexView, offset + 24, kUint8, "VEC4", count);
    accessor_text_.Add(",\"normalized\":true}");
    const size_t corners = add_corners();
    mesh_text_.Add(meshes_ == 0 ? "\n" : ",\n",
                   "{\"primitives\":[{\"attributes\":{\"POSITION\":", first,
                   ",\"NORMAL\":", first + 1, ",\"COLOR_0\":", first + 2, "},\"indices\":", corners,
                   ",\"material\":0}]}");
    ++meshes_;
  }

  // Returns its number and leaves its JSON object open.
  size_t AddAccessor(int view, size_t offset, int type, std::string_view shape, size_t count) {
    accessor_text_.Add(accessors_ == 0 ? "\n" : ",\n", "{\"bufferView\":", view,
                       ",\"byteOffset\":", offset, ",\"componentType\":", type,
                       ",\"count\":", count, ",\"type\":\"", shape, '"');
    return accessors_++;
  }
  size_t AddCorners(size_t offset, size_t count) {
    const size_t number = AddAccessor(kCornerView, offset, kUint32, "SCALAR", count);
    accessor_text_.Add('}');
    return number;
  }

  // Tubes with the same number of vertices share it.
  size_t CornersAccessor(const Tube& tube) {
    const auto [found, is_new] = corner_accessors_.emplace(tube.vertices.size(), accessors_);
    if (!is_new) return found->second;
    const std::vector<uint32_t> corners = tube.Corners(0);
    const size_t first = corners_.size();
    AppendItems(corners_, corners);
    return AddCorners(first, corners.size());
  }

  std::string Json(const WorldPoint& center, bool y_up, const MethodFacts& facts) {
    Text text;
    text.Add("{\"asset\":{\"version\":\"2.0\",\"generator\":\"bccskel\"},\n\"scene\":0,\"scenes\":",
             "[{\"nodes\":[0]}],\n\"nodes\":[\n{\"name\":\"skeleton\",\"translation\":[");
    if (y_up) {
      text.Add(center[0], ',', center[1], ',', center[2], ']');
    } else {  // a quarter turn about x: z points up
      text.Add(center[0], ',', center[2], ',', -center[1],
               "],\"rotation\":[-0.7071067811865476,0,0,0.7071067811865476]");
    }
    for (const auto& [name, value] : facts) {
      text.Add(&name == &facts.front().first ? ",\"extras\":{" : ",", JsonString(name), ':',
               JsonString(value));
    }
    if (!facts.empty()) text.Add('}');
    if (meshes_ > 0) text.Add(",\"children\":[");
    for (size_t n = 1; n <= meshes_; ++n) text.Add(n == 1 ? "" : ",", n);
    text.Add(meshes_ > 0 ? "]}" : "}");
    text.Add(std::move(node_text_).Take(), "\n]");
    if (meshes_ > 0) AddMeshes(text);
    text.Add("}\n");
    return std::move(text).Take();
  }

  void AddMeshes(Text& text) {
    text.Add(
        ",\n\"materials\":[{\"name\":\"radius\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
        "\"roughnessFactor\":0.6}}],\n\"meshes\":[",
        std::move(mesh_text_).Take(), "\n],\n\"accessors\":[", std::move(accessor_text_).Take());
    text.Add("\n],\n\"bufferViews\":[\n{\"buffer\":0,\"byteLength\":", vertices_.size(),
             ",\"byteStride\":", kVertexBytes, ",\"target\":", kOfVertices,
             "},\n{\"buffer\":0,\"byteOffset\":", vertices_.size(),
             ",\"byteLength\":", corners_.size(), ",\"target\":", kOfCorners,
             "}\n],\n\"buffers\":[{\"byteLength\":", vertices_.size() + corners_.size(), "}]");
  }

  const bool joined_;
  std::optional<Box> box_;  // of the joined tubes
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

std::string JoinedNote(size_t branches) {
  Text note;
  note.Add(branches, " branches are one mesh without their names and figures: programs that show ",
           "GLB take long for more than ", kMostMeshes, " meshes");
  return std::move(note).Take();
}

}  // namespace

absl::StatusOr<Document> WriteGlb(const SkeletonGraph& graph, const GraphContext& context,
                                  const World& world) {
  const WorldPoint center = CenterOf(graph);
  const TubeMaker maker(center, graph, context.labels);
  // A curve has about as many samples as points; one more for caps.
  Scene scene(graph.edges.size(), maker.sides() * (graph.points.size() + graph.edges.size()));
  // Tubes are made in rounds, so that their memory is used again.
  constexpr size_t kRound = 4096, kAtOnce = 64;
  std::vector<Tube> tubes(kRound);
  for (size_t first = 0; first < graph.edges.size(); first += kRound) {
    const size_t count = std::min(kRound, graph.edges.size() - first);
    const absl::Status made = context.exec.ForEachShare(count, kAtOnce, [&](exec::Share share) {
      for (size_t n = share.begin; n < share.end; ++n) {
        const SkeletonEdge& edge = graph.edges[first + n];
        tubes[n] = maker.Around(edge, SampledCurve(graph, edge, SmoothCurve(graph, edge)));
      }
    });
    if (!made.ok()) break;
    for (size_t n = 0; n < count; ++n) {
      if (tubes[n].vertices.empty()) continue;
      if (!tubes[n].IsFinite()) {
        return absl::InvalidArgumentError("the skeleton's coordinates do not fit a float32");
      }
      scene.Add(tubes[n]);
      if (scene.joined()) continue;
      const SkeletonEdge& edge = graph.edges[first + n];
      scene.AddNode(BranchName(context.labels, first + n), FiguresOf(graph, edge));
    }
  }
  const std::string note = scene.joined() ? JoinedNote(graph.edges.size()) : "";
  BCCSKEL_ASSIGN_OR_RETURN(std::string file,
                           std::move(scene).File(center, world.axes == kYUp, context.facts));
  return Document{std::move(file), note};
}

}  // namespace bccskel::exporting
