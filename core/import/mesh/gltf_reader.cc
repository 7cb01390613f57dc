// glTF 2.0: the triangles of all meshes of the default scene, moved by their nodes. Coordinates
// stay as stored, where y is up and lengths are meters by convention. Skins, morph targets and
// animations are not applied; materials, normals and colors are dropped.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/gltf_accessor.h"
#include "core/import/mesh/gltf_buffers.h"
#include "core/import/mesh/gltf_item.h"
#include "core/import/mesh/gltf_transform.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kDraco = "KHR_draco_mesh_compression";

// Extensions that a file may require since they do not move triangles.
bool IsHarmless(std::string_view extension) {
  constexpr std::array<std::string_view, 7> kHarmless = {
      "KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "EXT_texture_",
      "MSFT_texture_",         "KHR_lights_",    "KHR_xmp"};
  for (const std::string_view known : kHarmless) {
    if (extension.starts_with(known)) return true;
  }
  return false;
}

// What a primitive takes to read, beside its numbers.
constexpr uint64_t kNumbersOfPrimitive = 16;

enum class GltfMode : uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

class GltfReader {
 public:
  GltfReader(const GltfFile& file, std::optional<std::string> folder, uint64_t document_bytes,
             const MeshLimits& limits)
      : document_(file.document),
        buffers_(file, std::move(folder), limits.max_file_bytes),
        accessors_(file, buffers_, document_bytes),
        mesh_(limits) {}

  absl::StatusOr<TriangleMesh> Read() && {
    BCCSKEL_RETURN_IF_ERROR(CheckAsset());
    BCCSKEL_ASSIGN_OR_RETURN(std::vector<uint64_t> roots, Roots());
    for (const uint64_t root : roots) BCCSKEL_RETURN_IF_ERROR(ReadTree(root));
    if (mesh_.triangle_count() > 0) return std::move(mesh_).Finish();
    return absl::InvalidArgumentError(absl::StrFormat(
        "glTF: the scene draws no triangles (%d nodes, %d primitives, of points or lines)",
        visited_.size(), primitives_));
  }

 private:
  struct PlacedNode {
    uint64_t index;
    GltfTransform transform;  // of what is above it
  };

  absl::Status CheckAsset() const {
    const std::string version(GltfItem(document_, "").Inside("asset").Text("version"));
    if (!version.starts_with("2.")) {
      return absl::InvalidArgumentError(
          absl::StrFormat("glTF: asset.version is '%s'; 2.0 is read", version.substr(0, 40)));
    }
    for (const Json& required : GltfMember(document_, "extensionsRequired")) {
      if (required.is_string() && !IsHarmless(required.get_ref<const std::string&>())) {
        return absl::InvalidArgumentError(absl::StrFormat(
            "glTF: the file requires the extension %s, which is not read; export the mesh without "
            "it (compression, for example)",
            required.get_ref<const std::string&>().substr(0, 80)));
      }
    }
    return absl::OkStatus();
  }

  // Of the default scene, else of the first one, else all nodes that are nobody's child.
  absl::StatusOr<std::vector<uint64_t>> Roots() const {
    const GltfItem document(document_, "document");
    if (!document.Has("scenes")) return NodesWithoutParent();
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t index, document.WholeOr("scene", 0));
    BCCSKEL_ASSIGN_OR_RETURN(const GltfItem scene, GltfItem::At(document_, "scenes", index));
    return scene.Wholes("nodes");
  }

  absl::StatusOr<std::vector<uint64_t>> NodesWithoutParent() const {
    const Json& nodes = GltfMember(document_, "nodes");
    std::vector<bool> is_child(nodes.size());
    for (uint64_t n = 0; n < nodes.size(); ++n) {
      BCCSKEL_ASSIGN_OR_RETURN(const GltfItem node, GltfItem::At(document_, "nodes", n));
      BCCSKEL_ASSIGN_OR_RETURN(const std::vector<uint64_t> children, node.Wholes("children"));
      for (const uint64_t child : children) {
        if (child < is_child.size()) is_child[child] = true;
      }
    }
    std::vector<uint64_t> roots;
    for (uint64_t n = 0; n < is_child.size(); ++n) {
      if (!is_child[n]) roots.push_back(n);
    }
    return roots;
  }

  // In the order of the file, without recursion: a tree may be as deep as the file is long.
  absl::Status ReadTree(uint64_t root) {
    std::vector<PlacedNode> pending = {{root, GltfTransform()}};
    while (!pending.empty()) {
      const PlacedNode placed = pending.back();
      pending.pop_back();
      BCCSKEL_ASSIGN_OR_RETURN(const GltfItem node, GltfItem::At(document_, "nodes", placed.index));
      if (!visited_.insert(placed.index).second) {
        return node.Error("is reached twice; nodes must form trees, without cycles");
      }
      BCCSKEL_ASSIGN_OR_RETURN(const GltfTransform own, GltfTransform::Of(node));
      const GltfTransform transform = placed.transform.After(own);
      if (node.Has("mesh")) BCCSKEL_RETURN_IF_ERROR(ReadMesh(node, transform));
      BCCSKEL_ASSIGN_OR_RETURN(const std::vector<uint64_t> children, node.Wholes("children"));
      for (size_t n = children.size(); n > 0; --n) pending.push_back({children[n - 1], transform});
    }
    return absl::OkStatus();
  }

  absl::Status ReadMesh(const GltfItem& node, const GltfTransform& transform) {
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t index, node.Whole("mesh"));
    BCCSKEL_ASSIGN_OR_RETURN(const GltfItem mesh, GltfItem::At(document_, "meshes", index));
    const Json& primitives = mesh["primitives"];
    if (!primitives.is_array()) return mesh.Error("primitives must be a list");
    std::map<uint64_t, PointRange> placed;  // primitives often share their points
    for (size_t n = 0; n < primitives.size(); ++n) {
      BCCSKEL_RETURN_IF_ERROR(accessors_.Charge(kNumbersOfPrimitive));
      const GltfItem primitive(primitives[n],
                               absl::StrFormat("meshes[%d].primitives[%d]", index, n));
      BCCSKEL_RETURN_IF_ERROR(ReadPrimitive(primitive, transform, placed));
    }
    return absl::OkStatus();
  }

  // Points of the mesh that we make.
  struct PointRange {
    uint64_t first = 0;
    uint64_t count = 0;
  };

  absl::Status ReadPrimitive(const GltfItem& primitive, const GltfTransform& transform,
                             std::map<uint64_t, PointRange>& placed) {
    ++primitives_;
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t mode, primitive.WholeOr("mode", 4));
    if (mode > 6) return primitive.Error(absl::StrFormat("mode is %d, not one of 0 to 6", mode));
    if (mode < static_cast<uint64_t>(GltfMode::kTriangles)) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(const PointRange points, PointsOf(primitive, transform, placed));
    BCCSKEL_ASSIGN_OR_RETURN(std::vector<int64_t> corners, CornersOf(primitive, points));
    return AddTriangles(primitive, static_cast<GltfMode>(mode), transform, corners);
  }

  absl::StatusOr<PointRange> PointsOf(const GltfItem& primitive, const GltfTransform& transform,
                                      std::map<uint64_t, PointRange>& placed) {
    const GltfItem attributes = primitive.Inside("attributes");
    if (!attributes.Has("POSITION")) {
      const bool draco = primitive.Inside("extensions").Has(kDraco);
      return primitive.Error(draco ? "KHR_draco_mesh_compression is not read; export the mesh "
                                     "without compression"
                                   : "has no POSITION");
    }
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t index, attributes.Whole("POSITION"));
    const auto known = placed.find(index);
    if (known != placed.end()) return known->second;
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> values, accessors_.Positions(index));
    const PointRange range = {mesh_.vertex_count(), values.size() / 3};
    for (size_t n = 0; n + 2 < values.size(); n += 3) {
      BCCSKEL_RETURN_IF_ERROR(
          mesh_.AddVertex(transform.Apply({values[n], values[n + 1], values[n + 2]})));
    }
    placed.emplace(index, range);
    return range;
  }

  absl::StatusOr<std::vector<int64_t>> CornersOf(const GltfItem& primitive,
                                                 const PointRange& points) {
    std::vector<int64_t> corners;
    const auto first = static_cast<int64_t>(points.first);
    if (!primitive.Has("indices")) {
      BCCSKEL_RETURN_IF_ERROR(accessors_.Charge(points.count));
      for (uint64_t n = 0; n < points.count; ++n)
        corners.push_back(first + static_cast<int64_t>(n));
      return corners;
    }
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t index, primitive.Whole("indices"));
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> values, accessors_.Indices(index));
    for (const double value : values) {
      if (value >= static_cast<double>(points.count)) {
        return primitive.Error(
            absl::StrFormat("names point %.0f (counted from 0) of %d", value, points.count));
      }
      corners.push_back(first + static_cast<int64_t>(value));
    }
    return corners;
  }

  absl::Status AddTriangles(const GltfItem& primitive, GltfMode mode,
                            const GltfTransform& transform, std::vector<int64_t>& corners) {
    const bool mirrors = transform.Mirrors();
    if (mode == GltfMode::kFan) {
      if (mirrors && !corners.empty()) std::reverse(corners.begin() + 1, corners.end());
      return mesh_.AddPolygon(corners);
    }
    if (mode == GltfMode::kStrip) {
      // A corner twice at the start swaps the turns of all triangles.
      if (mirrors && !corners.empty()) corners.insert(corners.begin(), corners.front());
      return mesh_.AddStrip(corners);
    }
    if (corners.size() % 3 != 0) {
      return primitive.Error(
          absl::StrFormat("has %d corners, not three for each triangle", corners.size()));
    }
    for (size_t n = 0; n < corners.size(); n += 3) {
      if (mirrors) std::swap(corners[n + 1], corners[n + 2]);
      BCCSKEL_RETURN_IF_ERROR(mesh_.AddPolygon({&corners[n], 3}));
    }
    return absl::OkStatus();
  }

  const Json& document_;
  GltfBuffers buffers_;
  GltfAccessors accessors_;
  MeshAssembler mesh_;
  std::set<uint64_t> visited_;  // nodes
  uint64_t primitives_ = 0;
};

}  // namespace

absl::StatusOr<TriangleMesh> ParseGltf(std::string_view bytes, std::optional<std::string> folder,
                                       const MeshLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const GltfFile file, ParseGltfFile(bytes));
  return GltfReader(file, std::move(folder), bytes.size(), limits).Read();
}

}  // namespace bccskel
