#ifndef BCCSKEL_CORE_LABELS_SKELETONIZE_LABELS_H_
#define BCCSKEL_CORE_LABELS_SKELETONIZE_LABELS_H_

#include <cstdint>
#include <functional>

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {

struct LabelsOptions {
  MaskOptions mask = {};
  SkeletonizeOptions skeleton = {};
  // Objects from here on are thinned by all threads together, the others by one thread each.
  uint64_t large_voxels = uint64_t{1} << 18;
};

struct LabelSkeleton {
  uint64_t label = 0;
  uint64_t voxels = 0;
  SkeletonizeResult result;  // its certificate includes the mask's topology
};

// Takes the skeletons by ascending label, one at a time, from any thread. An error ends the work.
using LabelConsumer = std::function<absl::Status(LabelSkeleton&&)>;

// The skeleton of every object, separate from the others. Results have the same bits and come in
// the same order for any number of threads. A few finished results wait for their turn at most.
// Errors: as MaskConverter and Skeletonize(), with the label; those of the consumer as they are;
//         INTERNAL if an exact conversion changed the topology, which would be a defect of this
//         library; CANCELLED, DEADLINE_EXCEEDED.
absl::Status SkeletonizeLabels(const LabeledObjects& labels, const LabelsOptions& options,
                               const LabelConsumer& consume, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_SKELETONIZE_LABELS_H_
