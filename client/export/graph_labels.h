#ifndef BCCSKEL_CLIENT_EXPORT_GRAPH_LABELS_H_
#define BCCSKEL_CLIENT_EXPORT_GRAPH_LABELS_H_

#include <cstdint>
#include <vector>

namespace bccskel::exporting {

// Which label of an image each row of a graph belongs to. Empty where a graph is of one object.
struct GraphLabels {
  std::vector<uint64_t> of_nodes;
  std::vector<uint64_t> of_edges;
  std::vector<uint64_t> of_sheets;  // by point
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GRAPH_LABELS_H_
