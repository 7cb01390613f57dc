#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_GATHER_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_GATHER_H_

#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "core/exec/context.h"
#include "core/exec/worker_team.h"

namespace bccskel {

// What the items append, in their order whatever the number of threads; incomplete if the context
// requests a stop. Workers take `at_once` items at a time. `make_worker()` returns what a worker
// calls as `(size_t item, std::vector<T>& out)`.
template <typename T, typename MakeWorker>
std::vector<T> Gather(size_t items, size_t at_once, const exec::Context& context,
                      MakeWorker make_worker) {
  std::vector<std::vector<T>> found(items / at_once + 1);
  (void)context.ForEach(context.usable_threads(), items, at_once, [&](int) {
    return [&, worker = make_worker()](size_t n) mutable { worker(n, found[n / at_once]); };
  });
  std::vector<T> all;
  for (std::vector<T>& part : found) {
    all.insert(all.end(), std::move_iterator(part.begin()), std::move_iterator(part.end()));
  }
  return all;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_GATHER_H_
