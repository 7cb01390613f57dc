#ifndef BCCSKEL_CLIENT_EXPORT_SWC_H_
#define BCCSKEL_CLIENT_EXPORT_SWC_H_

#include <optional>
#include <stop_token>

#include "client/export/method_facts.h"
#include "client/export/point_forest.h"
#include "client/export/text.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::exporting {

struct SwcOptions {
  CurveSampling sampling = {};
  MethodFacts facts = {};     // of the header, which states world and unit only if these do
  std::stop_token stop = {};  // ends early; the text is then incomplete
};

// SWC: `id type x y z radius parent`, one tree per component (see PointForest), from the roots of
// the order, or else from the deepest node of each component.
// Types: 1 the roots of an order of thickest nodes, 6 end, 5 junction, 0 everything else. World
// coordinates and units, rounded to a ten-thousandth of the smallest spacing.
Document WriteSwc(const SkeletonGraph& graph, const std::optional<TreeOrder>& order = std::nullopt,
                  const SwcOptions& options = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SWC_H_
