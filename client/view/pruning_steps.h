#ifndef BCCSKEL_CLIENT_VIEW_PRUNING_STEPS_H_
#define BCCSKEL_CLIENT_VIEW_PRUNING_STEPS_H_

#include <cstdint>
#include <vector>

#include "client/view/result_document.h"
#include "core/exec/context.h"
#include "core/skeleton/skeleton_figures.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::view {

// A junction that the result lacks because it was merged into another.
struct PrunedNode {
  WorldPoint position;
  double radius;
  uint32_t component;
};

struct PrunedBranch {
  uint32_t source;  // index into the result's nodes, followed by PruningSteps::nodes
  uint32_t target;
  EdgeFigures figures;
  double level;                 // infinity: never pruned
  std::vector<uint32_t> edges;  // edges of the result that make up the branch
  bool shared;                  // no edge belongs to this branch alone
};

struct NodeState {
  uint32_t node;
  NodeKind kind;

  friend auto operator<=>(const NodeState&, const NodeState&) = default;
};

// What appears and disappears: indices into the result's items, followed by the additional ones.
struct Change {
  std::vector<uint32_t> on;
  std::vector<uint32_t> off;
};

struct PruningStep {
  double level;  // the threshold is just above this
  Change states;
  Change branches;
};

// The graphs that pruning leaves of a result, each as the difference from the previous one; the
// first from the result.
struct PruningSteps {
  std::vector<PrunedNode> nodes;
  std::vector<NodeState> states;       // after those of the result's nodes
  std::vector<PrunedBranch> branches;  // after the result's edges
  std::vector<PruningStep> steps;
};

// No steps if no edge has a level, if the result states no lattice, as in older versions, or after
// a stop request.
PruningSteps PruningStepsOf(const ResultDocument& document, const exec::Context& context = {});

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_PRUNING_STEPS_H_
