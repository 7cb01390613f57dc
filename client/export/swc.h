#ifndef BCCSKEL_CLIENT_EXPORT_SWC_H_
#define BCCSKEL_CLIENT_EXPORT_SWC_H_

#include <optional>
#include <string>

#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::exporting {

struct SwcDocument {
  std::string text;
  // What the format cannot show and was left out, a sentence for the user; empty if nothing was.
  std::string note;
};

// SWC: `id type x y z radius parent`, one tree per component (see PointForest).
// Types: 6 end, 5 junction, 0 everything else. World coordinates and units.
SwcDocument WriteSwc(const SkeletonGraph& graph,
                     const std::optional<TreeOrder>& order = std::nullopt);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SWC_H_
