#include <utility>
#include <vector>

#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/json_text.h"
#include "client/cli/local_team.h"
#include "client/cli/result_object.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "core/io/volume_file.h"
#include "core/reconstruct/overlap.h"
#include "core/reconstruct/union_of_balls.h"

namespace bccskel::cli {
namespace {

// A ball around every point of the skeleton, in lattice units of the object's grid.
std::vector<OpenBall> BallsOf(const view::ResultDocument& result, const Placement& placement) {
  // The radius in world units is that in lattice units times half the mean spacing.
  const auto& spacing = placement.spacing;
  const double unit = (spacing[0] + spacing[1] + spacing[2]) / 3 / 2;
  std::vector<OpenBall> balls;
  for (const view::ResultDocument::Node& node : result.nodes) {
    balls.push_back({LatticePlaceOf(node.position, placement), node.radius / unit});
  }
  for (const view::ResultDocument::Edge& edge : result.edges) {
    for (size_t n = 0; n < edge.points.size(); ++n) {
      balls.push_back({LatticePlaceOf(edge.points[n], placement), edge.radii[n] / unit});
    }
  }
  return balls;
}

std::string SummaryOf(const ReconstructArguments& arguments, uint64_t points,
                      const Overlap& overlap) {
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"result\":", JsonString(arguments.source.result),
             ",\"object\":", JsonString(arguments.source.object),
             ",\"output\":", JsonString(arguments.output), ",\"points\":", points,
             ",\"common_points\":", overlap.common, ",\"jaccard\":", overlap.Jaccard(), "}\n");
  } else {
    text.Add("points:      ", exporting::GroupedDigits(points), ", of them in the object ",
             exporting::GroupedDigits(overlap.common), "\noverlap:     ", overlap.Jaccard(),
             " (points in both / points in either)\nwritten:     ", arguments.output, '\n');
  }
  return std::move(text).Take();
}

}  // namespace

ExitCode Run(const ReconstructArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<ResultAndObject> loaded =
      LoadResultAndObject(arguments.source, team.context());
  if (!loaded.ok()) return Fail(loaded.status());
  const Volume& object = loaded->object;
  const absl::StatusOr<Volume> balls =
      UnionOfBalls(BallsOf(loaded->result, object.placement()), object.extent(), object.placement(),
                   team.context());
  if (!balls.ok()) return Fail(balls.status());
  const absl::Status written = WriteVolumeFile(arguments.output, *balls, {}, team.context());
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, balls->PointCount(), MeasureOverlap(object, *balls)));
}

}  // namespace bccskel::cli
