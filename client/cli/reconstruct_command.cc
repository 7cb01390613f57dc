#include <utility>

#include "absl/strings/str_format.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "client/view/result_balls.h"
#include "core/export/reconstruct/overlap.h"
#include "core/export/reconstruct/union_of_balls.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

std::string SummaryOf(const ReconstructArguments& arguments, uint64_t points,
                      const Overlap& overlap) {
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add(FilesJson(arguments), ",\"points\":", points, ",\"common_points\":", overlap.common,
             ",\"jaccard\":", overlap.Jaccard(), "}\n");
  } else {
    text.Add("points:      ", exporting::GroupedDigits(points), ", of them in the object ",
             exporting::GroupedDigits(overlap.common),
             "\noverlap:     ", absl::StrFormat("%.4f", overlap.Jaccard()),
             " (points in both / points in either)\nwritten:     ", arguments.output, '\n');
  }
  return std::move(text).Take();
}

}  // namespace

void AddReconstruct(CLI::App& command, ReconstructArguments& arguments) {
  AddResultAndObject(command, arguments, ObjectNeed::kRequired);
  AddOutput(command, arguments.output, "Volume", {".exr", ".bccb"});
}

ExitCode Run(const ReconstructArguments& arguments, const std::stop_token& stop) {
  LocalTeam team(arguments.common.threads, stop);
  const ProgressBar bar(arguments.common.progress);
  const absl::StatusOr<ResultAndObject> loaded =
      LoadResultAndObject(arguments, bar, team.context());
  if (!loaded.ok()) return Fail(loaded.status());
  const Volume& object = *loaded->object;  // it is required
  bar.Begin("filling the balls");
  const absl::StatusOr<Volume> balls =
      UnionOfBalls(view::BallsOf(loaded->result, object.placement()), object.extent(),
                   object.placement(), team.context());
  if (!balls.ok()) return Fail(balls.status());
  bar.Begin("writing", arguments.output);
  const absl::Status written = WriteVolumeFile(arguments.output, *balls, team.context());
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, balls->PointCount(), MeasureOverlap(object, *balls)));
}

}  // namespace bccskel::cli
