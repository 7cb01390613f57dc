#ifndef BCCSKEL_CLIENT_EXPORT_GRAPH_CONTEXT_H_
#define BCCSKEL_CLIENT_EXPORT_GRAPH_CONTEXT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/export/method_facts.h"
#include "core/exec/context.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::exporting {

// The label of each row of a graph. Empty for a graph of one object.
struct GraphLabels {
  std::vector<uint64_t> names = {};  // each label once, also those whose skeletons are empty
  std::vector<uint64_t> of_nodes;
  std::vector<uint64_t> of_edges;
  std::vector<uint64_t> of_sheets;  // by point
};

// For each label its place among the names. Needs: both are in the same order.
inline std::vector<uint32_t> PlacesOf(const std::vector<uint64_t>& labels,
                                      const std::vector<uint64_t>& names) {
  std::vector<uint32_t> places;
  places.reserve(labels.size());
  uint32_t place = 0;
  for (const uint64_t label : labels) {
    while (names[place] != label) ++place;
    places.push_back(place);
  }
  return places;
}

// "branch 7", or "label 3 branch 7" if there are labels; counted from 0.
inline std::string BranchName(const GraphLabels& labels, size_t edge) {
  std::string name = "branch " + std::to_string(edge);
  if (labels.of_edges.empty()) return name;
  return "label " + std::to_string(labels.of_edges[edge]) + " " + name;
}

// Additional facts about a graph. Each part may be missing.
struct GraphContext {
  GraphLabels labels = {};
  MethodFacts facts = {};
  std::optional<TreeOrder> order = std::nullopt;
  // Who composes the file. A stop ends it early; the file is then incomplete and must not be
  // written.
  exec::Context exec = {};
};

inline std::optional<TreeOrder> OrderOf(const SkeletonGraph& graph,
                                        const std::optional<RootChoice>& root,
                                        const std::stop_token& stop = {}) {
  if (!root.has_value()) return std::nullopt;
  return OrderTrees(graph, *root, stop);
}

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GRAPH_CONTEXT_H_
