#include <bit>
#include <string>

#include "core/digest/sha256.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {
namespace {

class LittleEndianBytes {
 public:
  void Add(uint32_t value) { AddBytes(value); }
  void Add(int32_t value) { AddBytes(static_cast<uint32_t>(value)); }
  void Add(uint64_t value) { AddBytes(value); }
  void Add(const SkeletonPoint& p) {
    Add(p.point.x);
    Add(p.point.y);
    Add(p.point.z);
    Add(std::bit_cast<uint32_t>(p.radius));
  }
  void Add(std::string_view text) { bytes_ += text; }
  const std::string& bytes() const { return bytes_; }

 private:
  template <typename Unsigned>
  void AddBytes(Unsigned value) {
    for (size_t n = 0; n < sizeof(value); ++n) bytes_ += static_cast<char>(value >> (8 * n));
  }

  std::string bytes_;
};

}  // namespace

// Layout, all numbers little-endian:
//   the 19 characters "bccskel.skeleton.v3"
//   u64 number of nodes, then for each node
//     u32 kind: 0 end, 1 junction, 2 loop, 3 isolated, 4 closed surface
//     i32 x, i32 y, i32 z, f32 radius, u32 loops, u32 cavities
//   u64 number of edges, then for each edge
//     u32 source, u32 target, u64 number of points, then for each point
//     i32 x, i32 y, i32 z, f32 radius
//   u64 number of points of sheets, then for each point
//     i32 x, i32 y, i32 z, f32 radius
std::string SkeletonDigest(const SkeletonGraph& graph) {
  LittleEndianBytes bytes;
  bytes.Add(std::string_view("bccskel.skeleton.v3"));
  bytes.Add(uint64_t{graph.nodes.size()});
  for (const SkeletonNode& node : graph.nodes) {
    bytes.Add(static_cast<uint32_t>(node.kind));
    bytes.Add(node.at);
    bytes.Add(node.loops);
    bytes.Add(node.cavities);
  }
  bytes.Add(uint64_t{graph.edges.size()});
  for (const SkeletonEdge& edge : graph.edges) {
    bytes.Add(edge.source);
    bytes.Add(edge.target);
    bytes.Add(edge.point_count);
    for (const SkeletonPoint& p : graph.PointsOf(edge)) bytes.Add(p);
  }
  bytes.Add(uint64_t{graph.sheets.size()});
  for (const SkeletonPoint& p : graph.sheets) bytes.Add(p);
  return Sha256Of(bytes.bytes()).Hex();
}

}  // namespace bccskel
