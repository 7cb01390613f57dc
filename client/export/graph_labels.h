#ifndef BCCSKEL_CLIENT_EXPORT_GRAPH_LABELS_H_
#define BCCSKEL_CLIENT_EXPORT_GRAPH_LABELS_H_

#include <cstdint>
#include <vector>

namespace bccskel::exporting {

// The label of each row of a graph. Empty for a graph of one object.
struct GraphLabels {
  std::vector<uint64_t> of_nodes;
  std::vector<uint64_t> of_edges;
  std::vector<uint64_t> of_sheets;  // by point
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GRAPH_LABELS_H_
