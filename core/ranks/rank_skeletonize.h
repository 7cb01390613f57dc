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

// OK for the options that ranks support. Errors: INVALID_ARGUMENT, with what to do instead.
absl::Status CheckRankOptions(const SkeletonizeOptions& options);

// Rank 0's part of a job. The other ranks are in FollowLead() meanwhile.
class Lead {
 public:
  // Needs: `exchange` outlives this; all ranks have equal checkpoint options.
  explicit Lead(Exchange& exchange, const CheckpointOptions& checkpoints = {})
      : exchange_(exchange), checkpoints_(checkpoints) {}
  ~Lead();  // makes FollowLead() return
  Lead(const Lead&) = delete;
  Lead& operator=(const Lead&) = delete;

  // Skeletonize(): all ranks measure distances, thin and count the object's topology; the result
  // is the same for any number of ranks. `object` is this rank's part and becomes the whole object,
  // from which this rank alone computes radii, pruning and the graph. Preparation gathers the whole
  // object here at the start.
  // Errors: those of Skeletonize(), CheckRankOptions() and other ranks' parts; CANCELLED and
  //         DEADLINE_EXCEEDED if any rank must stop.
  absl::StatusOr<SkeletonizeResult> Skeletonize(Volume& object, const SkeletonizeOptions& options,
                                                const exec::Context& context);

 private:
  Exchange& exchange_;
  const CheckpointOptions checkpoints_;
};

// The part of all other ranks, until rank 0's Lead is destroyed. `part` is this rank's part of the
// first object, or the reason why there is none.
// Needs:  no brick is in two ranks' parts; parts with bricks have rank 0's extent and placement.
// Errors: of the last job.
absl::Status FollowLead(Exchange& exchange, const exec::Context& context,
                        absl::StatusOr<Volume> part, const CheckpointOptions& checkpoints = {});

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_
