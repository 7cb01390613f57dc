#ifndef BCCSKEL_CLIENT_EXPORT_GRAPH_CONTEXT_H_
#define BCCSKEL_CLIENT_EXPORT_GRAPH_CONTEXT_H_

#include <optional>
#include <stop_token>

#include "client/export/graph_labels.h"
#include "client/export/method_facts.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::exporting {

// Additional facts about a graph. Each part may be missing.
struct GraphContext {
  GraphLabels labels = {};
  MethodFacts facts = {};
  std::optional<TreeOrder> order = std::nullopt;
  // Ends composing early; the file is then incomplete and must not be written.
  std::stop_token stop = {};
};

inline std::optional<TreeOrder> OrderOf(const SkeletonGraph& graph,
                                        const std::optional<RootChoice>& root,
                                        const std::stop_token& stop = {}) {
  if (!root.has_value()) return std::nullopt;
  return OrderTrees(graph, *root, stop);
}

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GRAPH_CONTEXT_H_
