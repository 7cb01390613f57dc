#ifndef BCCSKEL_CLIENT_VIEW_RESULT_GRAPH_H_
#define BCCSKEL_CLIENT_VIEW_RESULT_GRAPH_H_

#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/view/result_document.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::view {

// A JSON result with its graph on its lattice.
struct ResultGraph : ResultFacts {
  SkeletonGraph graph;
  std::optional<RootChoice> root;  // of a result with an order
};

// Errors: INVALID_ARGUMENT for a result without placement, from older versions, and for positions
//         that are not on its lattice; CANCELLED after a stop request.
absl::StatusOr<ResultGraph> ResultGraphOf(const ResultDocument& document,
                                          const std::stop_token& stop = {});

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RESULT_GRAPH_H_
