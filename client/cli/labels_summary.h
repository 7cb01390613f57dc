#ifndef BCCSKEL_CLIENT_CLI_LABELS_SUMMARY_H_
#define BCCSKEL_CLIENT_CLI_LABELS_SUMMARY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "client/cli/arguments.h"
#include "client/cli/skeleton_summary.h"
#include "core/import/image/image_info.h"
#include "core/labels/skeletonize_labels.h"

namespace bccskel::cli {

// What is said of one label.
struct LabelFigures {
  uint64_t label = 0;
  uint64_t voxels = 0;
  uint64_t object_points = 0;
  uint64_t skeleton_points = 0;
  size_t nodes = 0;
  size_t edges = 0;
  Certificate certificate;
  std::vector<PreparingStep> preparing;
  std::string sha256;
};
LabelFigures FiguresOf(const LabelSkeleton& skeleton);

// All that `labels` has to say at its end.
struct LabelsSummary {
  const LabelsArguments& arguments;
  const ImageInfo& info;
  uint64_t left_out = 0;
  std::vector<LabelFigures> labels;
  std::vector<WrittenFile> files;
  double seconds = 0;
};

// Text, or one JSON object on one line, as the arguments ask.
std::string LabelsSummaryOf(const LabelsSummary& summary);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LABELS_SUMMARY_H_
