#ifndef BCCSKEL_CORE_RANKS_AGREEMENT_H_
#define BCCSKEL_CORE_RANKS_AGREEMENT_H_

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/ranks/exchange.h"

namespace bccskel::ranks {

// OK on all ranks or on none: CANCELLED or DEADLINE_EXCEEDED if one of them must stop.
inline absl::Status AgreeToGoOn(Exchange& exchange, const exec::Context& context) {
  absl::Status own = context.StopStatus();
  uint64_t stopped = own.ok() ? 0 : 1;
  exchange.Max({&stopped, 1});
  if (!own.ok() || stopped == 0) return own;
  return absl::CancelledError("the job was stopped on another rank");
}

// OK on all ranks or on none. Rank 0 receives the first error and the number of its rank.
absl::Status AgreeOn(Exchange& exchange, const absl::Status& own);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_AGREEMENT_H_
