#include "client/view/display_curve.h"

#include <span>

#include "core/exec/status_macros.h"

namespace bccskel::view {
namespace {

// One binomial smoothing step. Needs: a point.
void SmoothOnce(std::span<WorldPoint> curve) {
  WorldPoint before = curve.front();
  for (size_t n = 1; n + 1 < curve.size(); ++n) {
    const WorldPoint here = curve[n];
    for (size_t axis = 0; axis < 3; ++axis) {
      curve[n][axis] = (before[axis] + 2 * here[axis] + curve[n + 1][axis]) / 4;
    }
    before = here;
  }
}

}  // namespace

absl::StatusOr<std::vector<WorldPoint>> DisplayCurvesOf(const ResultDocument& result,
                                                        const exec::Context& context) {
  const bool smooth = !result.curves.empty();
  std::vector<WorldPoint> curves = smooth ? result.curves : result.points;
  const int steps = smooth ? 2 : 6;  // points are steps of the lattice
  constexpr size_t kAtOnce = 2048;
  BCCSKEL_RETURN_IF_ERROR(
      context.ForEachShare(result.edges.size(), kAtOnce, [&](exec::Share share) {
        for (size_t n = share.begin; n < share.end; ++n) {
          const ResultDocument::Edge& edge = result.edges[n];
          if (edge.point_count == 0) continue;
          for (int step = 0; step < steps; ++step) {
            SmoothOnce(std::span(curves).subspan(edge.first_point, edge.point_count));
          }
        }
      }));
  return curves;
}

}  // namespace bccskel::view
