#include "client/view/result_balls.h"

namespace bccskel::view {

std::vector<OpenBall> BallsOf(const ResultDocument& result, const Placement& placement) {
  std::vector<OpenBall> balls;
  const auto add = [&](const WorldPoint& p, double radius) {
    balls.push_back({LatticePlaceOf(p, placement), radius});
  };
  for (const ResultDocument::Node& node : result.nodes) add(node.position, node.radius);
  for (size_t n = 0; n < result.points.size(); ++n) add(result.points[n], result.radii[n]);
  const ResultDocument::Sheets& sheets = result.sheets;
  for (size_t n = 0; n < sheets.points.size(); ++n) add(sheets.points[n], sheets.radii[n]);
  return balls;
}

}  // namespace bccskel::view
