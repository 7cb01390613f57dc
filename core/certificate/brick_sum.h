#ifndef BCCSKEL_CORE_CERTIFICATE_BRICK_SUM_H_
#define BCCSKEL_CORE_CERTIFICATE_BRICK_SUM_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/exec/context.h"

namespace bccskel {

// Work per brick, for Context::WorkersFor(): workers meet once.
inline constexpr size_t kBrickSumWork = 8;

// The sum of term(worker, batch) over batches that make up 0..count-1, in increasing order for
// each worker. If the context stops, the sum is meaningless.
template <typename Term>
int64_t SumOverBricks(const exec::Context& context, size_t count, Term term) {
  // A noisy brick costs up to 20 us, so a batch ends well within 20 ms.
  constexpr size_t kBatch = 128;
  const int workers = context.WorkersFor(count, kBrickSumWork);
  std::vector<int64_t> sums(static_cast<size_t>(workers), 0);
  (void)context.ForEachShare(workers, count, kBatch, [&](int worker) {
    return [&, worker](exec::Share batch) {
      sums[static_cast<size_t>(worker)] += term(worker, batch);
    };
  });
  return std::accumulate(sums.begin(), sums.end(), int64_t{0});
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_BRICK_SUM_H_
