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
  exec::Portions portions(items, at_once);
  context.Offer([&](int) {
    auto worker = make_worker();
    for (exec::Share mine = portions.Take(); mine.begin < mine.end; mine = portions.Take()) {
      if (context.ShouldStop()) return;
      for (size_t n = mine.begin; n < mine.end; ++n) worker(n, found[mine.begin / at_once]);
    }
  });
  std::vector<T> all;
  for (std::vector<T>& part : found) {
    all.insert(all.end(), std::move_iterator(part.begin()), std::move_iterator(part.end()));
  }
  return all;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_GATHER_H_
