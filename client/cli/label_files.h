#ifndef BCCSKEL_CLIENT_CLI_LABEL_FILES_H_
#define BCCSKEL_CLIENT_CLI_LABEL_FILES_H_

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/skeleton_summary.h"
#include "client/export/labeled_graph.h"
#include "core/labels/skeletonize_labels.h"

namespace bccskel::cli {

// What stands in a path for the number of the label: such a path is one file per label.
inline constexpr const char* kLabelPlace = "{label}";

// OK for a path with {label} and any format, and for one without and a format that can hold many
// skeletons. Errors: INVALID_ARGUMENT.
absl::Status CheckLabelOutput(const std::string& path);

// The output files of the skeletons of many labels.
class LabelFiles {
 public:
  // Needs: CheckLabelOutput() is OK for all.
  LabelFiles(const std::vector<std::string>& paths, const std::optional<RootChoice>& root,
             exporting::World world, exporting::CurveSampling swc);

  // Writes the label's own files, and keeps what goes into the files of all labels.
  // Errors: as WriteSkeletonFile().
  absl::Status Add(LabelSkeleton&& skeleton);

  // Writes the files of all labels. Errors: as above; CANCELLED.
  absl::StatusOr<std::vector<WrittenFile>> Finish(const std::stop_token& stop) &&;

 private:
  std::vector<std::string> paths_of_each_;
  std::vector<std::string> paths_of_all_;
  const std::optional<RootChoice> root_;
  const exporting::World world_;
  const exporting::CurveSampling swc_;
  exporting::LabeledSkeletons all_;
  uint64_t labels_ = 0;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LABEL_FILES_H_
