#ifndef BCCSKEL_CORE_SKELETON_TREE_ORDER_H_
#define BCCSKEL_CORE_SKELETON_TREE_ORDER_H_

#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "core/lattice/lattice_point.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// Where the tree of each component begins.
struct RootChoice {
  enum class Rule : uint8_t {
    // The end whose edge has the largest mean radius; in a component without ends its deepest node.
    kThickestEnd,
    // The node nearest to `point`, for each component.
    kNearestNode,
    // The deepest node of each component.
    kDeepestNode,
    // The nodes in `nodes`; the thickest end in components without one.
    kNodes,
  };
  Rule rule = Rule::kThickestEnd;
  WorldPoint point = {0, 0, 0};
  std::vector<uint32_t> nodes = {};

  friend bool operator==(const RootChoice&, const RootChoice&) = default;
};

// Errors: INVALID_ARGUMENT for a node that the graph does not have.
absl::Status CheckRootChoice(const RootChoice& choice, const SkeletonGraph& graph);

// A warning if the chosen point is probably not in the object: more than two radii away from the
// nearest point of the skeleton. Otherwise empty.
std::string RootWarning(const RootChoice& choice, const SkeletonGraph& graph);

inline constexpr uint32_t kNoRow = std::numeric_limits<uint32_t>::max();

struct NodeOrder {
  uint32_t root = 0;         // root of its component
  uint32_t parent = kNoRow;  // the next node on the way to the root; none for a root
  double root_distance = 0;  // along the edges, world units
};

// The order of an edge. An edge that closes a loop is not part of a tree: it has no proximal node,
// generation and order.
struct EdgeOrder {
  uint32_t proximal = kNoRow;  // which of its nodes is nearer to the root
  uint32_t generation = 0;     // forks between the root and the edge; 0 for the root's own edges
  uint32_t strahler = 0;       // 1 for an edge to a leaf; one more where two of the highest meet

  bool ClosesLoop() const { return proximal == kNoRow; }
};

// The graph as trees that grow from their roots.
struct TreeOrder {
  RootChoice::Rule rule = RootChoice::Rule::kThickestEnd;  // the rule that chose the roots
  std::vector<uint32_t> roots;   // by component, in the order of ComponentsOf()
  std::vector<NodeOrder> nodes;  // by node
  std::vector<EdgeOrder> edges;  // by edge
  uint64_t loops_cut = 0;        // edges that close loops

  uint32_t MostGenerations() const;
  uint32_t HighestStrahler() const;
};

// Does:  follows the shortest paths from the roots. Edges on none of them close loops and are left
//        out, so every component is a tree. Among paths of equal length, the one with the smaller
//        edge is taken.
// Needs: CheckRootChoice() is OK.
// After a stop request it returns early: `nodes` and `edges` have their sizes, but not all values.
TreeOrder OrderTrees(const SkeletonGraph& graph, const RootChoice& choice,
                     const std::stop_token& stop = {});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_TREE_ORDER_H_
