#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/convert_image.h"
#include "client/cli/label_files.h"
#include "client/cli/labels_summary.h"
#include "client/cli/load_image.h"
#include "client/cli/load_object.h"
#include "client/cli/local_team.h"
#include "core/exec/status_macros.h"
#include "core/import/image/open_image.h"
#include "core/labels/skeletonize_labels.h"

namespace bccskel::cli {
namespace {

using Clock = std::chrono::steady_clock;

absl::StatusOr<CollectedLabels> Collect(const LabelsArguments& arguments,
                                        const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(arguments.input, arguments.image.open));
  return CollectLabels(*source, arguments.image, arguments.min_voxels, context);
}

absl::StatusOr<CollectedLabels> Load(const LabelsArguments& arguments,
                                     const exec::Context& context) {
  absl::StatusOr<CollectedLabels> labels = Collect(arguments, context);
  if (!labels.ok()) return WithPath(labels.status(), arguments.input);
  if (labels->objects.objects.empty()) {
    return absl::InvalidArgumentError(arguments.input + ": has no such label of " +
                                      std::to_string(arguments.min_voxels) + " voxels or more");
  }
  return labels;
}

// Writes each label's files as soon as it is done, and remembers what the summary says of it.
absl::Status Deliver(LabelSkeleton&& skeleton, LabelFiles& files,
                     std::vector<LabelFigures>& figures) {
  figures.push_back(FiguresOf(skeleton));
  return files.Add(std::move(skeleton));
}

}  // namespace

ExitCode Run(const LabelsArguments& arguments, const std::stop_token& stop) {
  const Clock::time_point start = Clock::now();
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<CollectedLabels> labels = Load(arguments, team.context());
  if (!labels.ok()) return Fail(labels.status());
  LabelFiles files(arguments.outputs, arguments.root, WorldOf(labels->info), arguments.swc);
  std::vector<LabelFigures> figures;
  absl::Status writing;
  const absl::Status computed = SkeletonizeLabels(
      labels->objects, {.mask = arguments.image.mask, .skeleton = arguments.skeletonize},
      [&](LabelSkeleton&& skeleton) {
        writing = Deliver(std::move(skeleton), files, figures);
        return writing;
      },
      team.context());
  if (!writing.ok()) return FailWith(ExitCode::kOutput, writing);
  if (!computed.ok()) return Fail(WithPath(computed, arguments.input));
  absl::StatusOr<std::vector<WrittenFile>> written = std::move(files).Finish(stop);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written.status());
  return Print(LabelsSummaryOf({arguments, labels->info, labels->left_out, std::move(figures),
                                *std::move(written),
                                std::chrono::duration<double>(Clock::now() - start).count()}));
}

}  // namespace bccskel::cli
