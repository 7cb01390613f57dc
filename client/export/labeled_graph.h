#ifndef BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_
#define BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/export/graph_context.h"
#include "client/export/skeleton_file.h"
#include "client/export/subject.h"
#include "client/export/world.h"
#include "client/view/label_surfaces.h"
#include "core/exec/context.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// Collects the skeletons of many labels of one image for files that hold all of them.
class LabeledSkeletons {
 public:
  // `paths`: the files to write; only what they need is kept.
  explicit LabeledSkeletons(const std::vector<std::string>& paths,
                            const std::optional<RootChoice>& root = std::nullopt, World world = {});

  // After a stop request it returns early, with a part of the label's skeleton.
  // Needs: all have one placement; a label's skeletons come once, in one call.
  void Add(uint64_t label, uint64_t voxels, const SkeletonizeResult& result,
           const std::stop_token& stop = {});

  // Whether a file is a page or a picture, which also shows the objects.
  bool ShowsObjects() const { return shows_objects_; }
  // The objects of the labels, in the order in which they were added.
  // Errors: those of view::SurfacesOfLabels().
  absl::Status AddObjects(const view::ObjectOfLabel& object, const exec::Context& context);

  // All graphs side by side, with the sums of all certificates; the method of the first label.
  const SkeletonizeResult& all() const { return all_; }
  // Labels, the method of the first label, and the order of the trees if roots are chosen.
  GraphContext Context(const exec::Context& exec = {}) const;
  // {"labels": [{"label", "voxels", "skeleton"}, ...]}, each skeleton as JsonText() writes it.
  // Needs: a path that ends in .json.
  std::string Json() const { return "{\n\"labels\":[" + json_ + "\n]\n}\n"; }
  const World& world() const { return world_; }
  const std::optional<RootChoice>& root() const { return root_; }
  const view::DisplaySurface& surfaces() const { return surfaces_; }

 private:
  SkeletonizeResult all_;
  const std::optional<RootChoice> root_;
  const World world_;
  bool keeps_json_ = false;
  bool shows_objects_ = false;
  GraphLabels labels_;
  std::vector<uint64_t> sizes_;  // of each label: points, or voxels if preparation left none
  view::DisplaySurface surfaces_;
  MethodFacts facts_;
  std::string json_;
};

// All formats but .swc, .obj and volumes.
bool HoldsManyLabels(SkeletonFormat format);

// For pages and pictures.
struct LabeledPicture {
  std::string title;  // plain text
  exec::Context context = {};
  Drawing draw = nullptr;  // of .png files
};

// Returns what the format could not hold, as a sentence for the user; empty if it held everything.
// Needs:  for pages and pictures, the objects.
// Errors: INVALID_ARGUMENT for a format that holds one label only; as WriteSkeletonFile().
absl::StatusOr<std::string> WriteLabeledFile(const std::string& path,
                                             const LabeledSkeletons& skeletons,
                                             const LabeledPicture& picture = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_LABELED_GRAPH_H_
