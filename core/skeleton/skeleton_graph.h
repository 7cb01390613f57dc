#ifndef BCCSKEL_CORE_SKELETON_SKELETON_GRAPH_H_
#define BCCSKEL_CORE_SKELETON_SKELETON_GRAPH_H_

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/skeleton/thin_skeleton.h"
#include "core/volume/volume.h"

namespace bccskel {

// A cluster is a connected set of points that are not on a plain curve: three or more neighbors, or
// two that are adjacent to each other. A cluster without loops and cavities counts as one point: an
// isolated point, an end, a bend of its branch (no node) or a junction if it has no, one, two or
// more branches. A large cluster becomes several junctions, so that the number of points on edges
// is at most a constant times that of the skeleton.
enum class NodeKind : uint8_t {
  kEnd,            // one branch
  kJunction,       // three or more branches, or a cluster that encloses loops; see MergeJunctions()
  kLoop,           // stands for a closed curve without junction; one edge leads from it to itself
  kIsolated,       // no branch
  kClosedSurface,  // a cluster with cavities
};

// The unit of SkeletonPoint::shift is a lattice unit divided by this.
inline constexpr int kShiftUnits = 64;

// A skeleton point and the radius of the largest ball around it inside the object.
struct SkeletonPoint {
  LatticePoint point;
  // Exact Euclidean distance to the nearest background point in lattice units, half the shortest
  // edge of the cubic cell.
  float radius = 0;
  // The pass of thinning in which the point became an isthmus, from 1; 0 if it never did, or if the
  // kind of skeleton keeps no isthmuses. Each shell takes one pass, the last one several.
  int32_t birth = 0;
  // The offset from the smooth curve to the middle of the object across the curve, along each axis
  // of the lattice, in lattice units / kShiftUnits: see CenterCurves(). 0 for nodes, and if
  // distances are not Euclidean.
  std::array<int16_t, 3> shift = {0, 0, 0};

  friend constexpr auto operator<=>(const SkeletonPoint&, const SkeletonPoint&) = default;
};

struct SkeletonNode {
  NodeKind kind = NodeKind::kEnd;
  // The point that represents the node: for a cluster or a closed curve its deepest point, on ties
  // the smallest; for a cluster that encloses loops the deepest point on those loops.
  SkeletonPoint at;
  // Loops and cavities not represented by edges of the graph. Only closed surfaces have any.
  uint32_t loops = 0;
  uint32_t cavities = 0;

  friend constexpr bool operator==(const SkeletonNode&, const SkeletonNode&) = default;
};

// A branch, or a loop inside a cluster. Its points run from the source node's point to the target
// node's point, both included; consecutive points are neighbors in N14. Inside a cluster it takes a
// path with the fewest steps; through merged junctions it takes the edges between them, which it
// shares with others.
struct SkeletonEdge {
  uint32_t source = 0;  // index into nodes
  uint32_t target = 0;
  // Its points are [first_point, first_point + point_count) of SkeletonGraph::points.
  uint64_t first_point = 0;
  uint64_t point_count = 0;
  // The threshold above which pruning removes the edge, by significance or persistence: see
  // ThinSkeleton. Edges on loops, and one path of each tree, are never removed.
  double pruning_level = std::numeric_limits<double>::infinity();

  friend constexpr bool operator==(const SkeletonEdge&, const SkeletonEdge&) = default;
};

// The skeleton as a graph, in lattice coordinates; Placement takes it to the world.
// Invariants: loops of the object = edges - nodes + components + sum of the nodes' loops;
//             cavities of the object = sum of the nodes' cavities;
//             components of the graph = components of the object.
// Order is canonical: nodes by their point, edges by (source, target, points) with source <=
// target; an edge from a node to itself runs in the direction that gives the smaller sequence of
// points.
struct SkeletonGraph {
  Placement placement;
  std::vector<SkeletonNode> nodes;
  std::vector<SkeletonEdge> edges;
  std::vector<SkeletonPoint> points;  // of all edges, concatenated
  // Points on neither nodes nor edges: the sheets of a surface skeleton, all but one point of a
  // closed surface, and the thick spots of curves. Nodes, edges and these are all points of the
  // skeleton. In lattice order.
  std::vector<SkeletonPoint> sheets;

  std::span<const SkeletonPoint> PointsOf(const SkeletonEdge& edge) const {
    return std::span(points).subspan(edge.first_point, edge.point_count);
  }
  WorldPoint PositionOf(const SkeletonPoint& p) const { return placement.ToWorld(p.point); }
  // World units.
  double RadiusOf(const SkeletonPoint& p) const;
  // Whether its kind of skeleton keeps isthmuses and there are any.
  bool HasBirths() const;
  bool HasShifts() const;

  friend bool operator==(const SkeletonGraph&, const SkeletonGraph&) = default;
};

// SHA-256, in lower-case hex, over the numbers of the graph (lattice points, radii, kinds,
// topology) in canonical order. Placement, births, shifts and pruning levels are not included. The
// definition states the byte layout, which is a public contract.
// Errors: those of the context.
absl::StatusOr<std::string> SkeletonDigest(const SkeletonGraph& graph,
                                           const exec::Context& context = {});

// Extracts the graph of a skeleton. The invariants hold for any points; a volume that is not thin
// gives few nodes for large clusters, and many points of sheets. The level of an edge is the
// largest of its points, since an edge stays as long as a part of it stays.
// Cost:   proportional to the number of points.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<SkeletonGraph> TraceSkeleton(const ThinSkeleton& skeleton,
                                            const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_SKELETON_GRAPH_H_
