#ifndef BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_
#define BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "client/export/graph_context.h"
#include "client/export/skeleton_file.h"
#include "client/export/world.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// Collects the skeletons of many labels of one image for one file.
class LabeledSkeletons {
 public:
  explicit LabeledSkeletons(const std::optional<RootChoice>& root = std::nullopt, World world = {})
      : root_(root), world_(std::move(world)) {}

  // After a stop request it returns early, with a part of the label's skeleton.
  // Needs: all have one placement.
  void Add(uint64_t label, uint64_t voxels, const SkeletonizeResult& result,
           const std::stop_token& stop = {});

  // All graphs side by side.
  const SkeletonGraph& graph() const { return graph_; }
  // Labels, the method of the first label, and the order of the trees if roots are chosen.
  GraphContext Context(const std::stop_token& stop = {}) const;
  // {"labels": [{"label", "voxels", "skeleton"}, ...]}, each skeleton as JsonText() writes it.
  std::string Json() const { return "{\n\"labels\":[" + json_ + "\n]\n}\n"; }
  const World& world() const { return world_; }

 private:
  SkeletonGraph graph_;
  const std::optional<RootChoice> root_;
  const World world_;
  GraphLabels labels_;
  MethodFacts facts_;
  std::string json_;
};

// .vtp, .graphml, .json, .csv, .glb, .mrk.json and .precomputed.
bool HoldsManyLabels(SkeletonFormat format);

// Returns what the format could not hold, as a sentence for the user; empty if it held everything.
// Errors: INVALID_ARGUMENT for a format that holds one label only; as WriteGraphFile().
absl::StatusOr<std::string> WriteLabeledFile(const std::string& path,
                                             const LabeledSkeletons& skeletons,
                                             const std::stop_token& stop = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_
