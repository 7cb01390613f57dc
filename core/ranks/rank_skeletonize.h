#ifndef BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_
#define BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/pipeline/skeletonize.h"
#include "core/ranks/checkpoints.h"
#include "core/ranks/exchange.h"
#include "core/volume/volume.h"

namespace bccskel::ranks {

// OK for the options that ranks can keep to. Errors: INVALID_ARGUMENT, with what to do instead.
absl::Status CheckRankOptions(const SkeletonizeOptions& options);

// Rank 0's side of a job. The others are in FollowLead() meanwhile.
class Lead {
 public:
  // Needs: `exchange` outlives this; all ranks have equal checkpoint options.
  explicit Lead(Exchange& exchange, const CheckpointOptions& checkpoints = {})
      : exchange_(exchange), checkpoints_(checkpoints) {}
  ~Lead();  // lets the others go
  Lead(const Lead&) = delete;
  Lead& operator=(const Lead&) = delete;

  // Skeletonize(), where all ranks measure distances, thin and count the object's topology; the
  // same result for any number of them. `object` is this rank's part of it, and the whole
  // afterwards: of that radii, pruning and the graph are made here alone, after the others have
  // thinned. Preparing has the whole here from the beginning. Errors: as Skeletonize() and
  // CheckRankOptions(); those of other ranks' parts; CANCELLED and
  //         DEADLINE_EXCEEDED where any rank has to stop.
  absl::StatusOr<SkeletonizeResult> Skeletonize(Volume& object, const SkeletonizeOptions& options,
                                                const exec::Context& context);

 private:
  Exchange& exchange_;
  const CheckpointOptions checkpoints_;
};

// What ranks other than 0 do until rank 0 lets them go, in the first job with their part of the
// object or why they have none: no brick is in two ranks' parts, and parts with bricks have the
// extent and placement of rank 0's.
// Errors: of the last job.
absl::Status FollowLead(Exchange& exchange, const exec::Context& context,
                        absl::StatusOr<Volume> part, const CheckpointOptions& checkpoints = {});

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_
