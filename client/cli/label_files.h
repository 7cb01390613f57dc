#ifndef BCCSKEL_CLIENT_CLI_LABEL_FILES_H_
#define BCCSKEL_CLIENT_CLI_LABEL_FILES_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/file_writers.h"
#include "client/cli/image_options.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/export/labeled_graph.h"
#include "core/labels/skeletonize_labels.h"

namespace bccskel::cli {

// The output files of the skeletons of many labels.
class LabelFiles {
 public:
  // `threads`: of this job, which draw the pictures of single labels.
  // Needs: exporting::CheckLabelOutput() is OK for all outputs; the labels outlive it.
  LabelFiles(const LabelsArguments& arguments, const CollectedLabels& labels, int threads,
             std::stop_token stop);

  // Collects data for the files of all labels and queues the label's own files.
  // Errors: as WriteSkeletonFile(), also for an earlier label.
  absl::Status Add(LabelSkeleton&& skeleton);

  // Writes the files of all labels. Needs: all labels were added. Errors: as above; CANCELLED.
  absl::StatusOr<std::vector<WrittenFile>> Finish(const ProgressBar& bar,
                                                  const exec::Context& context) &&;

 private:
  absl::StatusOr<std::shared_ptr<const Volume>> ObjectOf(const LabeledObject& label) const;
  absl::Status WriteOwnFiles(const LabelSkeleton& skeleton) const;

  const LabeledObjects& labels_;
  const MaskOptions mask_;
  const std::string title_;
  const std::optional<RootChoice> root_;
  const exporting::World world_;
  const exporting::CurveSampling swc_;
  const std::vector<std::string> paths_of_each_;
  const std::vector<std::string> paths_of_all_;
  const bool each_shows_object_;
  exec::Context context_;  // of the writers: one thread
  exporting::LabeledSkeletons all_;
  uint64_t count_ = 0;
  FileWriters writers_;  // last: their tasks use the members above
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LABEL_FILES_H_
