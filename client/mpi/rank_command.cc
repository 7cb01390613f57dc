#include "client/mpi/rank_command.h"

#include <functional>
#include <string>
#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/console.h"
#include "client/export/skeleton_file.h"
#include "client/mpi/file_folder.h"
#include "core/exec/status_macros.h"
#include "core/ranks/agreement.h"
#include "core/ranks/rank_skeletonize.h"

namespace bccskel::cli {
namespace {

absl::Status CheckOutputFormats(const SkeletonizeArguments& arguments) {
  for (const std::string& path : arguments.outputs) {
    const auto format = exporting::SkeletonFormatOf(path);
    if (!format.ok() || *format != exporting::SkeletonFormat::kHtml) continue;
    return absl::InvalidArgumentError(
        path +
        ": ranks do not record the shells that a page shows; write .json, "
        "then `bccskel view RESULT.json --object OBJECT -o PAGE.html`");
  }
  return absl::OkStatus();
}

// Generates this rank's part of a shape; null if the input is a file.
std::function<absl::StatusOr<Volume>(const exec::Context&)> MakerOf(
    const SkeletonizeArguments& arguments, const RankOptions& options, ranks::Exchange& exchange) {
  if (!options.shape.has_value()) return nullptr;
  ShapeOptions shape = options.shape_options;
  shape.points = arguments.grid.points.value_or(shape.points);
  return [&exchange, shape, kind = *options.shape, part = arguments.part](const exec::Context&) {
    return GenerateShapePart(kind, shape, part, [&exchange](uint64_t points) {
      exchange.Sum({&points, 1});
      return points;
    });
  };
}

ExitCode RunLead(const SkeletonizeArguments& arguments, const RankOptions& options,
                 ranks::Exchange& exchange, const ranks::CheckpointOptions& checkpoints,
                 const std::stop_token& stop) {
  ranks::Lead lead(exchange, checkpoints);
  const auto compute = [&](Volume& object, const SkeletonizeOptions& chosen,
                           const exec::Context& context) {
    return lead.Skeletonize(object, chosen, context);
  };
  return RunShared({MakerOf(arguments, options, exchange), compute}, arguments, stop);
}

}  // namespace

absl::StatusOr<SkeletonizeArguments> RankArguments(Arguments arguments) {
  auto* chosen = std::get_if<SkeletonizeArguments>(&arguments);
  if (chosen == nullptr || chosen->accepted != AcceptedInput::kAll) {
    return absl::InvalidArgumentError(
        "bccskel-mpi runs `skeletonize` only; run other commands with `bccskel`");
  }
  if (chosen->place == Place::kServer) {
    return absl::InvalidArgumentError(
        "--server: ranks compute locally; omit it, or run `bccskel skeletonize`");
  }
  BCCSKEL_RETURN_IF_ERROR(ranks::CheckRankOptions(chosen->skeletonize));
  BCCSKEL_RETURN_IF_ERROR(CheckOutputFormats(*chosen));
  chosen->place = Place::kLocal;
  if (chosen->common.threads == 0) chosen->common.threads = 1;
  return std::move(*chosen);
}

ExitCode RunRank(SkeletonizeArguments arguments, const RankOptions& options,
                 ranks::Exchange& exchange, const std::stop_token& stop) {
  arguments.part = {exchange.rank(), exchange.size()};
  FileFolder folder(options.checkpoint_folder);
  const ranks::CheckpointOptions checkpoints = {
      options.checkpoint_folder.empty() ? nullptr : &folder, options.resuming,
      options.checkpoint_interval};
  absl::Status writable;
  if (exchange.rank() == 0) {
    writable = CheckOutputs(arguments);
    if (writable.ok() && checkpoints.folder != nullptr) writable = folder.Make();
  }
  const bool all_ready = ranks::AgreeOn(exchange, writable).ok();
  if (!all_ready && exchange.rank() != 0) return ExitCode::kOk;  // rank 0 says why
  if (!all_ready) return FailWith(ExitCode::kOutput, writable);
  if (exchange.rank() == 0) return RunLead(arguments, options, exchange, checkpoints, stop);
  LocalTeam team(arguments.common.threads, stop);
  const auto make = MakerOf(arguments, options, exchange);
  absl::StatusOr<Volume> part = make ? make(team.context()) : LoadPart(arguments, team.context());
  // Rank 0 reports the outcome.
  (void)ranks::FollowLead(exchange, team.context(), std::move(part), checkpoints);
  return ExitCode::kOk;
}

}  // namespace bccskel::cli
