#ifndef BCCSKEL_CLIENT_VIEW_PRUNING_STEPS_H_
#define BCCSKEL_CLIENT_VIEW_PRUNING_STEPS_H_

#include <cstdint>
#include <vector>

#include "client/view/result_document.h"
#include "core/skeleton/skeleton_figures.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::view {

// A node that the result itself does not have: a junction that it has merged into another.
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
  std::vector<uint32_t> edges;  // of the result, that the branch is made of
  bool shared;                  // no edge is the branch's own: it runs along this one
};

struct NodeState {
  uint32_t node;
  NodeKind kind;

  friend auto operator<=>(const NodeState&, const NodeState&) = default;
};

// What begins and ceases to be there. Index into the result's items, followed by the additional
// ones.
struct Change {
  std::vector<uint32_t> on;
  std::vector<uint32_t> off;
};

struct PruningStep {
  double level;  // the threshold is just above it
  Change states;
  Change branches;
};

// The graphs that pruning leaves of a result, each as the difference to the one before; the first
// to the result.
struct PruningSteps {
  std::vector<PrunedNode> nodes;
  std::vector<NodeState> states;       // behind those of the result's nodes
  std::vector<PrunedBranch> branches;  // behind the result's edges
  std::vector<PruningStep> steps;
};

// No steps where no edge has a level, or the result states no lattice, as those of older versions.
PruningSteps PruningStepsOf(const ResultDocument& document);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_PRUNING_STEPS_H_
