#ifndef BCCSKEL_CLIENT_EXPORT_BRANCH_NAME_H_
#define BCCSKEL_CLIENT_EXPORT_BRANCH_NAME_H_

#include <cstddef>
#include <string>

#include "client/export/graph_labels.h"

namespace bccskel::exporting {

// "branch 7", or "label 3 branch 7" if there are labels; counted from 0.
inline std::string BranchName(const GraphLabels& labels, size_t edge) {
  std::string name = "branch " + std::to_string(edge);
  if (labels.of_edges.empty()) return name;
  return "label " + std::to_string(labels.of_edges[edge]) + " " + name;
}

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_BRANCH_NAME_H_
