#ifndef BCCSKEL_CLIENT_VIEW_RESULT_GRAPH_H_
#define BCCSKEL_CLIENT_VIEW_RESULT_GRAPH_H_

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/view/result_document.h"
#include "core/certificate/certificate.h"
#include "core/prepare/prepare.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::view {

// The graph of a JSON result, on its lattice, and how it was made.
struct ResultGraph {
  SkeletonGraph graph;
  std::string method;
  std::string algorithm_version;
  std::string world;  // "unknown" if the input did not state it
  std::string unit;
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<PreparingStep> preparing;
  Certificate certificate;
  uint64_t object_points = 0;      // after preparing
  std::optional<RootChoice> root;  // of a result with an order
};

// Errors: INVALID_ARGUMENT as ReadResultGraph().
absl::StatusOr<ResultGraph> ResultGraphOf(const ResultDocument& document);

// Errors: those of ReadResultDocument(); INVALID_ARGUMENT for a result without placement, from
//         older versions, and for positions that are not on its lattice.
absl::StatusOr<ResultGraph> ReadResultGraph(const std::string& path);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RESULT_GRAPH_H_
