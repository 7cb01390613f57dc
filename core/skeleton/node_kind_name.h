#ifndef BCCSKEL_CORE_SKELETON_NODE_KIND_NAME_H_
#define BCCSKEL_CORE_SKELETON_NODE_KIND_NAME_H_

#include <string_view>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// The word for a node's kind in every text format: end, junction, loop, isolated, closed_surface.
constexpr std::string_view NodeKindName(NodeKind kind) {
  switch (kind) {
    case NodeKind::kEnd:
      return "end";
    case NodeKind::kJunction:
      return "junction";
    case NodeKind::kLoop:
      return "loop";
    case NodeKind::kIsolated:
      return "isolated";
    case NodeKind::kClosedSurface:
      return "closed_surface";
  }
  return "";  // not reached: the enumerators are exhausted above
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_NODE_KIND_NAME_H_
