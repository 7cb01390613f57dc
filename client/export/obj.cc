#include <utility>

#include "client/export/graph_formats.h"
#include "client/export/polylines.h"
#include "client/export/text.h"

namespace bccskel::exporting {

std::string ObjText(const SkeletonGraph& graph, const GraphContext& context) {
  const std::stop_token& stop = context.exec.stop;
  const Polylines polylines = PolylinesOf(graph, stop);
  Text text(stop);
  text.Add("# curve skeleton by bccskel\n");
  AddComments(text, context.facts);
  for (const WorldPoint& p : polylines.places) {
    if (text.stopped()) break;
    text.Add("v ", p[0], ' ', p[1], ' ', p[2], '\n');
  }
  for (const std::vector<size_t>& line : polylines.lines) {
    if (text.stopped()) break;
    text.Add('l');
    for (size_t n : line) text.Add(' ', n + 1);
    text.Add('\n');
  }
  for (size_t n : polylines.lone_points) text.Add("p ", n + 1, '\n');
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
