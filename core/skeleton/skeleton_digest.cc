#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <string>

#include "core/digest/sha256.h"
#include "core/exec/stop_poll.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {
namespace {

// Numbers on their way into a digest, little-endian. Collected first: a call for each would cost
// several times what digesting its bytes costs.
class DigestedNumbers {
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
  void Add(std::string_view text) {
    Flush();
    digest_.Add(text);
  }
  std::string Hex() && {
    Flush();
    return digest_.Finish().Hex();
  }

 private:
  template <typename Unsigned>
  void AddBytes(Unsigned value) {
    if (used_ + sizeof(value) > bytes_.size()) Flush();
    for (size_t n = 0; n < sizeof(value); ++n) {
      bytes_[used_ + n] = static_cast<std::byte>(value >> (8 * n));
    }
    used_ += sizeof(value);
  }
  void Flush() {
    digest_.Add(std::span(bytes_).first(used_));
    used_ = 0;
  }

  Sha256 digest_;
  std::array<std::byte, 16384> bytes_;
  size_t used_ = 0;
};

void AddNodes(const SkeletonGraph& graph, DigestedNumbers& numbers) {
  numbers.Add(uint64_t{graph.nodes.size()});
  for (const SkeletonNode& node : graph.nodes) {
    numbers.Add(static_cast<uint32_t>(node.kind));
    numbers.Add(node.at);
    numbers.Add(node.loops);
    numbers.Add(node.cavities);
  }
}

void AddPoints(std::span<const SkeletonPoint> points, StopPoll& poll, DigestedNumbers& numbers) {
  numbers.Add(uint64_t{points.size()});
  for (const SkeletonPoint& p : points) {
    if (poll.Stopped()) return;
    numbers.Add(p);
  }
}

void AddEdges(const SkeletonGraph& graph, StopPoll& poll, DigestedNumbers& numbers) {
  numbers.Add(uint64_t{graph.edges.size()});
  for (const SkeletonEdge& edge : graph.edges) {
    numbers.Add(edge.source);
    numbers.Add(edge.target);
    AddPoints(graph.PointsOf(edge), poll, numbers);
  }
}

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
absl::StatusOr<std::string> SkeletonDigest(const SkeletonGraph& graph,
                                           const exec::Context& context) {
  StopPoll poll(context);
  DigestedNumbers numbers;
  numbers.Add(std::string_view("bccskel.skeleton.v3"));
  AddNodes(graph, numbers);
  AddEdges(graph, poll, numbers);
  AddPoints(graph.sheets, poll, numbers);
  if (poll.Stopped()) return context.StopStatus();
  return std::move(numbers).Hex();
}

}  // namespace bccskel
