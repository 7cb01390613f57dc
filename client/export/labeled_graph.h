#ifndef BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_
#define BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "client/export/graph_labels.h"
#include "client/export/skeleton_file.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// The skeletons of many labels of one image, on their way into one file.
class LabeledSkeletons {
 public:
  // Needs: all have one placement.
  void Add(uint64_t label, uint64_t voxels, const SkeletonizeResult& result);

  // All graphs side by side.
  const SkeletonGraph& graph() const { return graph_; }
  const GraphLabels& labels() const { return labels_; }
  // {"labels": [{"label", "voxels", "skeleton"}, ...]}, each skeleton as JsonText() writes it.
  std::string Json() const { return "{\n\"labels\":[" + json_ + "\n]\n}\n"; }

 private:
  SkeletonGraph graph_;
  GraphLabels labels_;
  std::string json_;
};

// .vtp, .graphml and .json.
bool HoldsManyLabels(SkeletonFormat format);

// Errors: INVALID_ARGUMENT (a format that does not), and as WriteFileAtomically().
absl::Status WriteLabeledFile(const std::string& path, const LabeledSkeletons& skeletons);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_
