#ifndef BCCSKEL_CORE_CERTIFICATE_BRICK_SUM_H_
#define BCCSKEL_CORE_CERTIFICATE_BRICK_SUM_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/exec/context.h"

namespace bccskel {

// The sum of term(worker, n) for n = 0..count-1, each worker of the context taking one contiguous
// share. When the context says stop, the rest is left out and the sum means nothing.
template <typename Term>
int64_t SumOverBricks(const exec::Context& context, size_t count, Term term) {
  // A noisy brick costs up to 20 us, so a batch ends well within 20 ms.
  constexpr size_t kBatch = 512;
  std::vector<int64_t> sums(static_cast<size_t>(context.threads()), 0);
  context.Run([&](int worker) {
    const exec::Share share = exec::ShareOf(count, worker, context.threads());
    int64_t sum = 0;
    for (size_t n = share.begin; n < share.end && !context.ShouldStop();) {
      for (const size_t batch_end = std::min(share.end, n + kBatch); n < batch_end; ++n) {
        sum += term(worker, n);
      }
    }
    sums[static_cast<size_t>(worker)] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), int64_t{0});
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_BRICK_SUM_H_
