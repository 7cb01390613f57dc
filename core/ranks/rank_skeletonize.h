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

  // Skeletonize(), where all ranks measure distances and thin; the same result for any number of
  // them. The other stages run here alone, on the bits of the whole object.
  // Errors: as Skeletonize() and CheckRankOptions(); CANCELLED and DEADLINE_EXCEEDED where any rank
  //         has to stop.
  absl::StatusOr<SkeletonizeResult> Skeletonize(const Volume& object,
                                                const SkeletonizeOptions& options,
                                                const exec::Context& context);

 private:
  Exchange& exchange_;
  const CheckpointOptions checkpoints_;
};

// What ranks other than 0 do until rank 0 lets them go.
// Errors: of the last job.
absl::Status FollowLead(Exchange& exchange, const exec::Context& context,
                        const CheckpointOptions& checkpoints = {});

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_SKELETONIZE_H_
