#ifndef BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_
#define BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_

#include <exception>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/pipeline/skeletonize.h"
#include "core/ranks/checkpoints.h"
#include "core/ranks/exchange.h"
#include "core/volume/volume.h"

namespace bccskel::ranks {

// Checks that ranks support the options.
// Errors: INVALID_ARGUMENT, with an alternative.
absl::Status CheckRankOptions(const SkeletonizeOptions& options);

// Rank 0's side of a job, while the others run FollowLead().
class Lead {
 public:
  // Needs: `exchange` outlives this; all ranks have equal checkpoint options.
  explicit Lead(Exchange& exchange, const CheckpointOptions& checkpoints = {})
      : exchange_(exchange), checkpoints_(checkpoints) {}
  // Ends FollowLead() on the others, unless an exception is propagating.
  ~Lead();  // NOLINT(bugprone-exception-escape)
  Lead(const Lead&) = delete;
  Lead& operator=(const Lead&) = delete;

  // Skeletonize(), where all ranks measure distances, thin and count the object's topology; the
  // same result for any number of ranks. `object` is this rank's part on entry and the whole object
  // on return: this rank alone measures radii, prunes and traces the graph. For preparing, and for
  // a mask of one slice, it gathers the whole object at the start; the latter it processes alone.
  // Errors: as Skeletonize() and CheckRankOptions(); those of other ranks' parts; CANCELLED and
  //         DEADLINE_EXCEEDED if any rank has to stop.
  absl::StatusOr<SkeletonizeResult> Skeletonize(Volume& object, const SkeletonizeOptions& options,
                                                const exec::Context& context);

 private:
  Exchange& exchange_;
  const CheckpointOptions checkpoints_;
  const int exceptions_ = std::uncaught_exceptions();
};

// Runs the ranks other than 0 until rank 0 ends the job. `part` is the rank's part of the object
// for the first job, or the error that prevented it.
// Needs: no brick is in two ranks' parts, and parts with bricks have rank 0's extent and placement.
// Errors: of the last job.
absl::Status FollowLead(Exchange& exchange, const exec::Context& context,
                        absl::StatusOr<Volume> part, const CheckpointOptions& checkpoints = {});

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_
