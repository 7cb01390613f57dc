#ifndef BCCSKEL_PROTO_WIRE_SKELETON_CHUNKS_H_
#define BCCSKEL_PROTO_WIRE_SKELETON_CHUNKS_H_

#include <cstddef>
#include <cstdint>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/skeleton.pb.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::wire {

// The largest size of a serialized SkeletonChunk.
inline constexpr size_t kMaxSkeletonChunkBytes = 256 * 1024;

// Splits a graph into chunks, one at a time, so that a stream holds only one of them.
// Needs: `graph` outlives the pager and does not change.
class SkeletonChunkPager {
 public:
  explicit SkeletonChunkPager(const SkeletonGraph& graph);

  // The next chunk; nullopt after the last one. A graph without nodes has one empty chunk.
  std::optional<v1::SkeletonChunk> Next();

 private:
  void AddNodes(size_t& budget_bytes, v1::SkeletonNodeColumns& columns);
  void AddEdges(size_t& budget_bytes, v1::SkeletonEdgeColumns& columns);
  void AddPoints(size_t& budget_bytes, v1::SkeletonPointColumns& columns);
  void AddSheets(size_t& budget_bytes, v1::SkeletonPointColumns& columns);
  bool AtEnd() const;

  // Whether points are sent with their births and shifts.
  enum class Births : uint8_t { kNone, kSome };
  enum class Shifts : uint8_t { kNone, kSome };

  const SkeletonGraph* graph_;
  Births births_;
  Shifts shifts_;
  uint32_t sequence_ = 0;
  size_t node_ = 0;
  size_t edge_ = 0;
  size_t points_edge_ = 0;   // the edge whose points come next
  uint64_t edge_point_ = 0;  // and the point within it
  size_t sheet_point_ = 0;
};

// Assembles a graph from chunks and checks it: damaged or malicious chunks give an error, never a
// graph with dangling edges.
class SkeletonAssembler {
 public:
  // Errors: DATA_LOSS for a missing or repeated chunk, columns of different lengths, and kinds that
  //         this version does not know.
  absl::Status Add(const v1::SkeletonChunk& chunk);

  // Combines the summary and the chunks into a result.
  // Errors: DATA_LOSS for wrong counts, edges to missing nodes, edges whose points do not run from
  //         source to target, invalid radii, and a graph whose digest is not the summary's.
  absl::StatusOr<SkeletonizeResult> Finish(const v1::SkeletonSummary& summary) &&;

 private:
  uint32_t chunks_ = 0;
  SkeletonGraph graph_;
  uint64_t edge_points_ = 0;  // sum of the edges' point counts
};

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_SKELETON_CHUNKS_H_
